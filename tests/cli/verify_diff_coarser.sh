svdag-scene scan -n 5K -q -o a.ply
svdag build a.ply -r 512 -o fine.svdag -q
svdag build a.ply -r 256 -o coarse.svdag -q
svdag-verify diff fine.svdag coarse.svdag --show 0 --json
