svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 --part 2/3 -o r.run -q
svdag info r.run
svdag info r.run --json
