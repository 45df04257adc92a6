# Options as in other programs; a process limited to one processor has one thread.
svdag-scene speck -n 8 -q -o s.ply
svdag build s.ply -r 16 -o ./-a.svdag -q
svdag-trace --size=4x4 --samples 1 --rounds 1 -j2 -- -a.svdag | head -1
taskset -c "$(taskset -cp $$ | sed 's/.*[ :]\([0-9]*\).*/\1/')" \
  svdag-trace --size=4x4 --samples 1 --rounds 1 ./-a.svdag | head -1
svdag-trace ./-a.svdag --sise 9 || echo "exit $?"
svdag-trace ./-a.svdag --samples || echo "exit $?"
svdag-trace ./-a.svdag --samples 4 --samples 8 || echo "exit $?"
svdag-trace - || echo "exit $?"
