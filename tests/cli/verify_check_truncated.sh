svdag-scene rectangle -q -o r.ply
svdag build r.ply -r 64 -o r.svdag -q
head -c 1500 r.svdag > cut.svdag
svdag-verify check cut.svdag
