# A command of another program of the project is suggested with that program.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
for line in "check r.svdag" "verify check r.svdag" "trace r.svdag" "help render" "help svdag-trace" \
    "import r.ply -o x.svdag" "build r.svdag -r 64 -o x.svdag"; do
  svdag $line 2>&1 || echo "exit $?"
done
svdag-verify build r.ply 2>&1 || echo "exit $?"
