# A pattern that no part has is said: who mistypes a name judges by another scene than he thinks.
svdag-scene scan -n 5K -q -o scan.ply
svdag build scan.ply -r 128 -o scan.svdag -q
svdag-verify mesh scan.svdag scan.ply --exclude 'sky*'
svdag-verify mesh scan.svdag scan.ply --exclude 'sky*' --json
