# A step that another process does, left by a killed run, say: it may be asked for again, and a run waits for it.
svdag-scene city -n 2K -q -o c.ply
svdag plan c.ply -r 256 --shards 2 -o p -q
mkdir -m 700 p/runs/shard-1.run.scratch
flock p/runs/shard-1.run.scratch/owner sh -c 'touch held; sleep 5' &
until [ -e held ]; do sleep 0.02; done
svdag build p --shard 1 || echo "exit code $?"
svdag run p -j 1
wait
