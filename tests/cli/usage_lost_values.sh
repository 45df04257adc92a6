# An unset $OUT in a script: the next word is not taken as the value, and nothing is written.
svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
refused() { "$@" 2>&1 && echo "not refused: $*" || echo "exit $?"; }
refused svdag build r.ply -r 64 -o --quiet
refused svdag build r.ply -o -r 64
refused svdag build r.ply -r 64 -o x.svdag --report -q
refused svdag build r.ply -r 64 -o=x.svdag
refused svdag build r.ply -r 64 --output=
refused svdag build r.ply -r '' -o x.svdag
refused svdag build r.ply -s '' -o x.svdag
refused svdag build r.ply -r 64 -o x.svdag -j ''
refused svdag plan r.ply -r 64 --shards 1 -o --quiet
refused svdag export r.svdag -o x.npz --level ''
refused svdag import r.svdag -o x.svdag --grid ''
refused svdag-verify mesh r.svdag r.ply --seed ''
refused svdag-verify mesh r.svdag r.ply --sample 9 --seed -1
refused svdag-verify diff r.svdag r.svdag --show ''
refused svdag-verify render r.svdag -o --size 9x9
refused svdag-verify render r.svdag -o x.png --fly ''
refused svdag-scene city --seed 99999999999999999999 -o c.ply
refused svdag-scene city -n '' -o c.ply
# Negative numbers are values, and unusual names are accepted.
svdag build r.ply -r 64 -o ./--quiet.svdag -q --bounds -1,-1,-1,1,1,1
svdag build r.ply -r 64 -q --output==x.svdag
svdag build -r 64 -q -o y.svdag -- r.ply
ls
