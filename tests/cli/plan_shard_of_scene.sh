svdag-scene speck -n 100 -q -o s.ply
svdag build s.ply --shard 1
