svdag-scene scan -n 5K -q -o scan.ply
svdag build scan.ply -r 128 -o scan.svdag -q
svdag-verify mesh scan.svdag scan.ply
