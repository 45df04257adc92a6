svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 --part 1/2 -o r.run -q
svdag merge r.run ./r.run -o out.run
