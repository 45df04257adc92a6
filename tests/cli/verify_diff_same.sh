svdag-scene scan -n 5K -q -o a.ply
svdag build a.ply -r 512 -o a.svdag -q
svdag build a.ply -r 512 -o b.svdag -q -m 16M -j 1
svdag-verify diff a.svdag b.svdag
