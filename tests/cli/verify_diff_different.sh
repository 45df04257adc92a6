# The thin voxels are a subset of the conservative ones: nothing is only in the thin file.
svdag-scene scan -n 5K -q -o a.ply
svdag build a.ply -r 128 -o whole.svdag -q
svdag build a.ply -r 128 --rule thin -o thin.svdag -q
svdag-verify diff thin.svdag whole.svdag --show 3 --write-diff d.ply || echo "exit $?"
svdag-verify diff thin.svdag whole.svdag -q --write-diff d.ply --write-most 10
svdag-verify diff thin.svdag whole.svdag -q --write-diff d.vdb || echo "exit $?"
