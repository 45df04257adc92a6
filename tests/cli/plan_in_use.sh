# A step that another process runs (left by a killed run): svdag run waits for it while it runs the others.
svdag-scene city -n 2K -q -o c.ply
svdag plan c.ply -r 256 --shards 2 -o p -q
mkdir -m 700 p/runs/shard-1.run.scratch
flock p/runs/shard-1.run.scratch/owner sh -c 'touch held; for i in $(seq 200); do [ -e p/runs/shard-2.json ] || sleep 0.1; done' &
until [ -e held ]; do sleep 0.02; done
svdag build p --shard 1 || echo "exit code $?"
svdag run p -j 1
wait
