# Voxels in only one of the two files are written as two grids; with the thin file they form the whole.
svdag-scene scan -n 5K -q -o a.ply
svdag build a.ply -r 128 -o whole.svdag -q
svdag build a.ply -r 128 --rule thin -o thin.svdag -q
svdag export whole.svdag -o whole.vdb -q
svdag export thin.svdag -o thin.vdb -q
svdag-verify vdb thin.svdag whole.vdb --show 2 --write-diff d.vdb || echo "exit $?"
svdag-verify vdb whole.svdag d.vdb --grid missing --show 0 || echo "exit $?"
svdag-verify vdb whole.svdag thin.vdb --json --show 1 || echo "exit $?"
svdag-verify vdb whole.svdag thin.vdb -q --write-diff d.vdb --write-most 10 || echo "exit $?"
