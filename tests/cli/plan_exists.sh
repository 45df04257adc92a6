svdag-scene speck -n 100 -q -o s.ply
svdag plan s.ply -r 64 --shards 2 -o p -q
svdag plan s.ply -r 64 --shards 2 -o p/
