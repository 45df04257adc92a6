for line in "biuld x.ply" "build x.ply -o x.svdag --resolutoin 64" "info --jsno x.svdag"; do
  svdag $line 2>&1 || echo "exit $?"
done
for line in "chekc x.svdag" "mesh x.svdag x.ply --smaple 3"; do
  svdag-verify $line 2>&1 || echo "exit $?"
done
