svdag-scene scan -n 50K -q -o a.ply
svdag build a.ply -r 64 -o a.svdag -q
svdag-verify trace a.svdag a.ply -m 5M || echo "exit $?"
svdag-verify trace a.svdag a.ply -m 8M
