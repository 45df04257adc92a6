svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o missing/r.svdag
