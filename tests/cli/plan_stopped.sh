# Stopped by Ctrl-C, or by Slurm at its time limit, it says how to go on.
stop() {  # SIGNAL FILES COMMAND...: the signal comes when one of the files is there
  signal=$1 files=$2
  shift 2
  env --default-signal=INT "$@" &  # a shell lets its background ignore Ctrl-C
  until ls $files >/dev/null 2>&1; do sleep 0.02; done
  sleep 0.1
  kill -s "$signal" $!
  wait $! || echo "exit code $?"
}
svdag-scene scan -n 70K -q -o s.ply
svdag plan s.ply -r 8K --shards 2 --scratch . -o p -q
stop INT 'p/runs/*.scratch/owner' svdag build p --shard 1 -q
stop TERM '*.scratch/journal' svdag build p --shard 1 -q -m 8M --scratch .
svdag build p --shard 1 -q --scratch .
stop INT '*.scratch/owner' svdag run p -q -j 2 --scratch .

svdag plan s.ply -r 1K --shards 2 -o small -q
mkdir -p bin
printf '#!/bin/sh\necho 12\n' >bin/sbatch
printf '#!/bin/sh\ntouch asked\necho RUNNING\n' >bin/squeue
chmod +x bin/*
PATH=$PWD/bin:$PATH
stop INT asked svdag submit small --engine slurm --wait -q
