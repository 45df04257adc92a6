# A closed pipe ends the program by SIGPIPE, and its files are complete.
svdag-scene city -n 3K -q -o a.ply
closed() { { sleep 0.1; "$@" || echo "$1 $2: exit $?" >&2; } | true; }
closed svdag build a.ply -r 64 -o a.svdag
closed svdag info a.svdag
closed svdag-verify check a.svdag
closed svdag export a.svdag -o a.vdb
svdag-verify vdb a.svdag a.vdb -q
ls
