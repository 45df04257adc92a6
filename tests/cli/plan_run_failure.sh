svdag-scene city -n 2K -q -o c.ply
svdag plan c.ply -r 256 --shards 2 -o p -q
rm p/triangles
svdag run p -j 1
