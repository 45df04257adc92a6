# A plan instead of a scene or a run, and words that a plan's commands would ignore: each is rejected with a message.
refused() { "$@" 2>&1 || echo "exit $?"; }
svdag-scene speck -n 100 -q -o s.ply
svdag plan s.ply -r 64 --shards 2 -o p -q
refused svdag build p -o z.svdag -r 64
refused svdag build s.ply p -o z.svdag -r 64 --dry-run
refused svdag build p --shard 1 s.ply
refused svdag merge p -o z.svdag
refused svdag merge p p --step merge-1
refused svdag submit p --engine slurm -o t.json
refused svdag submit p p --engine slurm
refused svdag submit p --engine openjd --wait
for option in '--include x' '--exclude x' --skip-invalid --sandbox; do refused svdag info p $option; done
svdag run p -q -j 1
refused svdag info p/s.svdag --include x
refused svdag info p/runs/shard-1.run --sandbox
refused svdag build p --shard 1 -o z.svdag
refused svdag merge p --step merge-1 -o z.run
refused svdag merge p --step merge-1 -o z.vdb
svdag info p | tail -n 1
ls
