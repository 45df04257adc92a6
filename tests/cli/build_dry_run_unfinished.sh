# A dry run does not change an unfinished bake of the same output and leaves no other file.
svdag-scene scan -n 70K -q -o s.ply
mkdir beside elsewhere
for options in "" "--scratch elsewhere"; do
  svdag build s.ply -r 8K -o beside/s.svdag -q -m 8M $options &
  until test -n "$(find . -name journal)"; do sleep 0.02; done
  sleep 0.1
  kill -s KILL $!
  wait $! 2>/dev/null || true
  svdag build s.ply -r 8K -o beside/s.svdag --dry-run -q $options
  svdag build s.ply -r 8K -o beside/s.svdag -q -m 8M $options 2>/dev/null || echo "exit code $?"
  find beside elsewhere -name '*.scratch' | sed 's/-[0-9a-f]*\.scratch/-HASH.scratch/'
  rm -rf beside/* elsewhere/*
done
