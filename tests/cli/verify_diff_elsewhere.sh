svdag-scene scan -n 5K -q -o a.ply
svdag-scene city -n 5K -q -o c.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag build c.ply -r 64 -o c.svdag -q
svdag-verify diff a.svdag c.svdag
