# A step writes to the requested output, but never over a file of the plan, of another step, or of the scene.
svdag-scene sheet -q -o s.ply
svdag plan s.ply -r 64 --shards 2 -o p -q
svdag build p --shard 1 -q
svdag build p --shard 2 -q
cp -r p kept
cp s.ply kept.ply
ln p/index link
for output in s.ply p/plan.json p/index link p/triangles p/runs/shard-2.run p/runs/shard-1.json p/runs/merge-1.json \
              p/s.svdag; do
  svdag build p --shard 1 -o $output 2>&1 || echo "exit $?"
done
for output in ./s.ply p/plan.json p/triangles p/runs/shard-1.run p/runs/shard-2.json; do
  svdag merge p --step merge-1 -o $output 2>&1 || echo "exit $?"
done
diff -r kept p
cmp kept.ply s.ply
svdag build p --shard 1 -o ./p/runs/shard-1.run -q
svdag build p --shard 2 -o mine.run -q
svdag merge p --step merge-1 -o mine.svdag -q
svdag merge p --step merge-1 -o p/s.svdag -q
cmp mine.svdag p/s.svdag
cmp mine.run p/runs/shard-2.run
