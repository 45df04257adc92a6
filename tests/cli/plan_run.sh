svdag-scene city -n 5K -q -o c.ply
svdag build c.ply -r 512 -o one.svdag -q
svdag plan c.ply -r 512 --shards 5 --fan-in 2 -o p -m 200M
rm c.ply
svdag run p -j 2 -q
cmp one.svdag p/c.svdag && echo "the same bytes"
svdag info p | grep -v input
svdag build p --shard 2
svdag merge p --step merge-4 -q
svdag run p -j 2 | grep -v planned | LC_ALL=C sort
