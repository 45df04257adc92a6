svdag-scene rectangle -q -o r.ply
for part in 0/2 3/2 1-2 1/2x; do svdag build r.ply -r 64 --part $part -o r.run || true; done
svdag build r.ply -r 16 --part 1/64 -o r.run
