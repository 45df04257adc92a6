svdag-scene city -n 2K -q -o a.ply
svdag-scene city -n 2K --seed 2 -q -o b.ply
svdag plan a.ply -s 0.5 --shards 1 -o p -q
svdag plan b.ply -s 0.5 --shards 1 -o q -q
svdag run q -q
svdag build p --shard 1 -q
cp q/runs/shard-1.run p/runs/shard-1.run
svdag merge p --step merge-1
