svdag-scene rectangle -q -o r.ply
svdag-verify check r.ply
