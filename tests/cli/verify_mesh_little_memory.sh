svdag-scene scan -n 50K -q -o scan.ply
svdag build scan.ply -r 64 -o scan.svdag -q
svdag-verify mesh scan.svdag scan.ply --memory 2M
