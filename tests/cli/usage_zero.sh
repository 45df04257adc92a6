# Zero is a value, not the default; an invalid one gives a short message.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
refused svdag export r.svdag -o r.ply.npz --level 0
refused svdag-verify render r.svdag -o r.png --level 0
refused svdag-verify render r.svdag -o r.png --level 7
for command in 'svdag build r.ply -r 64 -o x.svdag' 'svdag plan r.ply -r 64 --shards 1 -o p' \
    'svdag info r.ply' 'svdag export r.svdag -o r.vdb' 'svdag import r.npz -o x.svdag' \
    'svdag-verify mesh r.svdag r.ply'; do
  refused $command -m 0
  refused $command -m 16
done
for seconds in 0 -1 nan; do
  refused svdag build r.ply -r 64 -o x.svdag --checkpoint=$seconds
done
refused svdag-verify mesh r.svdag r.ply --sample 0
refused svdag-verify mesh r.svdag r.ply --judge openvdb --sample 0
refused svdag-verify render r.svdag -o r.png --fly 0
refused svdag merge r.run -o ''
refused svdag build r.ply --shard 0
refused svdag build r.ply -r 64 -o x.svdag --checkpoint soon
svdag-verify render r.svdag -o r.png --level 6 --size 8x8 -q
svdag build r.ply -r 64 -o x.svdag --checkpoint 0.5 -q
ls
