# A sample of an empty file draws from the scene; if that is empty too, the result is not "ok".
printf 'v 0 0 0\nv 0 8 8\nv 8 0 8\nf 1 2 3\n' > scene.obj
printf 'v 0 0 0\nv 0 2 2\nv 2 0 2\nf 1 2 3\nv 0 0 9\n' > small.obj
# Inside the triangle's box, and beside the triangle.
svdag build scene.obj -s 0.125 --bounds=0,0,5,0.5,0.5,5.5 -o empty.svdag -q
svdag-verify mesh empty.svdag scene.obj | tail -1
svdag-verify mesh empty.svdag scene.obj --sample 10 || echo "exit code $?"
svdag-verify mesh empty.svdag scene.obj --sample 10 --judge openvdb || echo "exit code $?"
svdag-verify mesh empty.svdag small.obj --sample 10 | tail -1
svdag-verify mesh empty.svdag small.obj --sample 10 --judge openvdb | tail -1
# One draw is enough for a file that lacks every voxel.
printf 'v 0 0 5\nv 0.5 0 5\nv 0.5 0.5 5.5\nf 1 2 3\n' > there.obj
svdag-verify mesh empty.svdag there.obj --sample 1 -q || echo "exit code $?"
svdag-verify mesh empty.svdag there.obj --sample 1 --judge openvdb -q || echo "exit code $?"
