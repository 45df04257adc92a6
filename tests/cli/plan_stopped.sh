# Interrupted by Ctrl-C, or by Slurm at its time limit, each command reports how to continue.
stop() {  # SIGNAL FILES COMMAND...: sends the signal when one of the files exists
  signal=$1 files=$2
  shift 2
  env --default-signal=INT "$@" &  # background jobs of a shell ignore SIGINT
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
printf '#!/bin/sh\ntouch polled\necho RUNNING\n' >bin/squeue
chmod +x bin/*
PATH=$PWD/bin:$PATH
stop INT polled svdag submit small --engine slurm --wait -q
