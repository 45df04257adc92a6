svdag-scene scan -n 5K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag-verify trace a.svdag a.ply --rays 0
