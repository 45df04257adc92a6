svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
svdag merge r.svdag -o out.svdag
