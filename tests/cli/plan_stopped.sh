# Stopped by Ctrl-C, or by Slurm at its time limit: within a second, and it says how to go on.
stop() {  # SIGNAL COMMAND...; killed (exit code 137) if it is not gone in time: a second, and one for a busy machine
  signal=$1
  shift
  timeout --preserve-status -s "$signal" -k 2 0.5 "$@" || echo "exit code $?"
}
svdag-scene scan -n 70K -q -o s.ply
svdag plan s.ply -r 8K --shards 2 --scratch . -o p -q
stop INT svdag build p --shard 1 -q
stop TERM svdag build p --shard 1 -q -m 8M --scratch .
svdag build p --shard 1 -q --scratch . -m 8388608
stop INT svdag run p -q -j 2 --scratch .

svdag plan s.ply -r 1K --shards 2 -o small -q
mkdir -p bin
printf '#!/bin/sh\necho 12\n' >bin/sbatch
printf '#!/bin/sh\necho RUNNING\n' >bin/squeue
chmod +x bin/*
PATH=$PWD/bin:$PATH
stop INT svdag submit small --engine slurm --wait -q
