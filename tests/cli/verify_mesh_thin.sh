svdag-scene scan -n 1K -q -o scan.ply
svdag build scan.ply -r 64 --rule thin -o scan.svdag -q
svdag-verify mesh scan.svdag scan.ply --judge integer
svdag-verify mesh scan.svdag scan.ply --judge cgal
svdag-verify mesh scan.svdag scan.ply --judge cgal --sample 100 --json --memory 64M
