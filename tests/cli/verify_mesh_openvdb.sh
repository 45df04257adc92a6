# Both rules are within the bounds of OpenVDB's distances; the file of another scene is not.
svdag-scene city -n 3K -q -o a.ply
svdag-scene city -n 3K --seed 5 -q -o b.ply
svdag build a.ply -r 256 -o a.svdag -q
svdag build a.ply -r 256 --rule thin -o thin.svdag -q
svdag-verify mesh a.svdag a.ply --judge openvdb
svdag-verify mesh thin.svdag a.ply --judge openvdb
svdag build a.ply -r 8K -o large.svdag -q
svdag-verify mesh large.svdag a.ply --judge openvdb --sample 3 --json
svdag-verify mesh a.svdag b.ply --judge openvdb | grep -v "^  "
svdag-verify mesh a.svdag b.ply --judge openvdb -q
