# --resume and --restart exclude each other: the message of an interrupted bake names a command that works.
stop() {  # COMMAND...: sends the signal when there is work to resume
  env --default-signal=INT "$@" &  # background jobs of a shell ignore SIGINT
  until ls z.svdag.scratch/journal >/dev/null 2>&1; do sleep 0.02; done
  sleep 0.1
  kill -s INT $!
  wait $! || echo "exit code $?"
}
svdag-scene scan -n 70K -q -o s.ply
stop svdag build s.ply -r 8K -m 8M -o z.svdag -q
rm -r z.svdag.scratch
stop svdag build s.ply -r 8K -m 8M -o z.svdag -q --restart
rm -r z.svdag.scratch
echo '[{"scene": "s.ply", "output": "z.svdag", "resolution": "8K", "memory": "8M", "restart": true}]' > l.json
stop svdag build --batch l.json -q
rm -r z.svdag.scratch
echo '[{"scene": "s.ply", "output": "z.svdag", "resolution": "8K", "memory": "8M"}]' > l.json
stop svdag build --batch l.json -q --restart
