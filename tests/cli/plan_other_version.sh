# Every command recognises a plan of another version of svdag and does not change it.
svdag-scene speck -n 100 -q -o s.ply
svdag plan s.ply -r 64 --shards 2 -o p -q
sed -i 's/"format": 6/"format": 4/' p/plan.json
cp p/plan.json kept.json
svdag run p -j 1 2>&1 || echo "exit $?"
svdag build p --shard 1 2>&1 || echo "exit $?"
svdag info p 2>&1 || echo "exit $?"
svdag plan s.ply -r 64 --shards 2 -o p 2>&1 || echo "exit $?"
cmp kept.json p/plan.json
rm p/plan.json
svdag plan s.ply -r 64 --shards 2 -o p -q
svdag run p -q -j 1
