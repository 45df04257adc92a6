# The whole way: bake, check, compare every voxel, and tell what is in the file.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
svdag-verify check r.svdag -q
svdag-verify mesh r.svdag r.ply -q
svdag info r.svdag --levels
