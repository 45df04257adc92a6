svdag-scene rectangle -q -o r.ply
svdag build r.ply -s 0.75 --part 1/2 -o a.run -q
svdag build r.ply -s 0.7 --part 2/2 -o b.run -q
svdag merge a.run b.run -o out.svdag
