svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.run -q
svdag merge r.run -o ./r.run
