svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 --part 2/3 -o a.run -q
svdag build r.ply -r 64 --part 1/2 -o b.run -q
svdag merge a.run b.run -o out.svdag
