# Threads and the order of triangles do not affect the bytes.
svdag-scene city -n 6K --yaw 30 -q -o plain.ply
svdag-scene city -n 6K --yaw 30 --shuffle -q -o shuffled.ply
svdag build plain.ply -r 256 -j 1 -o one.svdag -q
svdag build plain.ply -r 256 -j 4 -o four.svdag -q
svdag build shuffled.ply -r 256 -j 3 -o shuffled.svdag -q
cmp one.svdag four.svdag
cmp one.svdag shuffled.svdag
sha256sum one.svdag
