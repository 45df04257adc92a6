svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -s 0.5 -o r.svdag
