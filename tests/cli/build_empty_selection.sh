# Bounds without triangles give a valid file without voxels.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -s 1 --bounds=500,500,500,501,501,501 -o r.svdag -q
svdag-verify check r.svdag -q
svdag info r.svdag --json | grep '"voxels"'
