# A sample finds missing voxels even of triangles without area, and gives bounds only for uniform draws.
awk 'BEGIN {
  for (i = 0; i < 3000; ++i) {
    x = 2 + i % 50 / 1000; y = 2 + i / 60000; n = 3 * i
    print "v", x, y, 2; print "v", x, y, 2.0001; print "v", x + 0.0001, y, 2
    print "o dots"; print "f", n + 1, n + 2, n + 3
  }
  print "v 0 0 0"; print "v 4 0.1 4"; print "f 9001 9001 9001"; print "f 9002 9002 9002"
  print "o needle"; print "v 0 0.013 0"; print "v 4 0.013 4"; print "f 9003 9004 9004"
}' > scene.obj
svdag build scene.obj -s 0.004 -o all.svdag -q
svdag build scene.obj -s 0.004 --exclude needle -o dots.svdag -q
svdag-verify mesh all.svdag scene.obj --sample 1000
svdag-verify mesh dots.svdag scene.obj --sample 1000 | grep -v "^  missing voxel"
svdag-verify mesh dots.svdag scene.obj --sample 100 -q && exit 1
svdag-verify mesh all.svdag scene.obj --sample 6 --json
