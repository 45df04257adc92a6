svdag-scene rectangle -q -o r.ply
svdag build r.ply -o r.svdag
