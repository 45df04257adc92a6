# A pattern that matches no part is reported: a mistyped name would verify against another scene.
svdag-scene scan -n 5K -q -o scan.ply
svdag build scan.ply -r 128 -o scan.svdag -q
svdag-verify mesh scan.svdag scan.ply --exclude 'sky*' --allow-empty
svdag-verify mesh scan.svdag scan.ply --exclude 'sky*' --allow-empty --json
