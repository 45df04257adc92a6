# "10K" counts in thousands; the count that was made is printed.
svdag-scene city -n 10K -o city.ply
svdag-scene scan --triangles 1.2M -o scan.ply
