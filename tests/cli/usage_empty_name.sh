# An empty name (an unset variable of a script) is an error before any work.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
svdag plan r.ply -r 64 --shards 1 -o p -q
svdag export r.svdag -o r.npz -q
refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
refused svdag-scene rectangle -o ''
refused svdag build r.ply -r 64 -o ''
refused svdag build '' -r 64 -o x.svdag
for option in --report --scratch --cache; do
  refused svdag build r.ply -r 64 -o x.svdag $option ''
done
refused svdag build --batch ''
refused svdag plan r.ply -r 64 --shards 1 -o ''
refused svdag run ''
refused svdag submit p --engine openjd -o ''
refused svdag merge ''
refused svdag info ''
refused svdag export r.svdag -o ''
refused svdag import r.npz -o ''
refused svdag-verify check ''
refused svdag-verify diff r.svdag r.svdag --write-diff ''
refused svdag-verify render r.svdag -o ''
refused svdag-trace r.svdag --dump ''
refused svdag-trace ''
ls
