svdag-scene scan -n 5K -q -o a.ply
svdag build a.ply -r 512 -o a.svdag -q
svdag-verify trace a.svdag a.ply --rays 20K
svdag build a.ply -r 512 --rule thin -o thin.svdag -q
svdag-verify trace thin.svdag a.ply --rays 20K --seed 7 --json
