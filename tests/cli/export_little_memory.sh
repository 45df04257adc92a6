# An export that does not fit in memory is rejected before it begins.
svdag-scene city -n 3K -q -o a.ply
svdag build a.ply -r 512 -o a.svdag -q
svdag export a.svdag -o a.vdb -m 1M || echo "exit $?"
svdag export a.svdag -o a.vdb -m 8M || echo "exit $?"
svdag export a.svdag -o a.vdb -m 1M --level 4 -q
ls
