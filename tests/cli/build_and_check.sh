# The whole workflow: bake, check, compare every voxel, print information.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
svdag-verify check r.svdag -q
svdag-verify mesh r.svdag r.ply -q
svdag info r.svdag --levels
