svdag-scene rectangle -q -o r.ply
svdag info r.ply >/dev/full
