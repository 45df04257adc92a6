svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.run -q
head -c 1500 r.run > short.run
svdag merge short.run -o out.svdag
