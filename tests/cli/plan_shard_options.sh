# The plan of a shard sets most options: those that the shard would ignore are rejected.
svdag-scene speck -n 100 -q -o s.ply
svdag plan s.ply -r 64 --shards 2 -o p -q
for options in '-r 64' '-s 0.1' '--rule thin' '--bounds 0,0,0,1,1,1' '--include x' '--exclude x' '--skip-invalid' \
               '--sandbox' '--part 1/2' '--cache c' '--cache c --cache-size 1G' '--report r.json' '--dry-run' \
               '--batch l.json' '--keep-going' '--no-plane-memo' '--vectors plain'; do
  svdag build p --shard 1 $options || echo "exit code $?"
done
ls
svdag build p --shard 1 -o o.run --scratch . -m 64M -j 1 --checkpoint 5 --restart --no-progress -v | grep -v seconds
svdag build p --shard 1 --resume -q
