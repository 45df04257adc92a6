svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 64 -o city.svdag -q
svdag-verify render city.svdag -o city.png --size 64x48 -q
head -c 8 city.png | od -An -tx1
