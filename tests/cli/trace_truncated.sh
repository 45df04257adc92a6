svdag-scene speck -n 8 -q -o a.ply
svdag build a.ply -r 16 -o a.svdag -q
head -c 1100 a.svdag > b.svdag
svdag-trace b.svdag
