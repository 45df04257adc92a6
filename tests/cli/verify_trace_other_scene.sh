# A coarser mesh of the same surface: some triangles have no voxel, some voxels no
# triangle, and it extends beyond the grid. Exit code 1.
svdag-scene scan -n 5K -q -o a.ply
svdag-scene scan -n 2K -q -o b.ply
svdag build a.ply -r 256 -o a.svdag -q
svdag-verify trace a.svdag b.ply --rays 5K
