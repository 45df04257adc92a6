svdag-scene speck -n 8 -q -o a.ply
svdag build a.ply -r 16 -o a.svdag -q
svdag-trace a.svdag --device cuda --size 8x8
