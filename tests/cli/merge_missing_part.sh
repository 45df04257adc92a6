svdag-scene rectangle -q -o r.ply
for i in 1 3; do svdag build r.ply -r 64 --part $i/3 -o $i.run -q; done
svdag merge 1.run 3.run -o out.svdag
