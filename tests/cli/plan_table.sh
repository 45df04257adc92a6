svdag-scene city -n 5K -q -o c.ply
svdag plan c.ply -r 512 --shards 2 -o p -v -m 200M
