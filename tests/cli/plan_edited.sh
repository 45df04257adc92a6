# A plan that was edited is rejected by every command, whatever was changed.
svdag-scene speck -n 100 -q -o s.ply
svdag plan s.ply -r 64 --shards 2 -o p -q
cp p/plan.json kept.json
for edit in 's/"voxel_size": /"voxel_size": 1/' 's/"rule": "conservative"/"rule": "thin"/' 's/"bounded": false/"bounded": true/' \
  's/s.svdag/t.svdag/' 's/"format": 6,/"format":  6,/'; do
  sed "$edit" kept.json > p/plan.json
  cmp -s kept.json p/plan.json && echo "nothing is changed by $edit"
  svdag run p -q -j 1 2>&1 || echo "exit $?"
done
svdag build p --shard 1 2>&1 || echo "exit $?"
svdag info p 2>&1 || echo "exit $?"
cp kept.json p/plan.json
svdag run p -q -j 1
