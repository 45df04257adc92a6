# Outputs that cannot be written are rejected before tracing, and none of them is written.
svdag-scene speck -n 8 -q -o s.ply
svdag build s.ply -r 16 -o a.svdag -q
mkdir folder
trace() { svdag-trace a.svdag --size 4x4 --samples 1 --rounds 1 "$@" || echo "exit $?"; }
trace --dump -
trace --dump folder
trace --dump nowhere/a.bin
trace --dump good.bin --picture nowhere/a.ppm
trace --picture "$(printf '%300s' | tr ' ' a).ppm" 2>&1 | cut -c1-20,300-
ls
