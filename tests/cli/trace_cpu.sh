svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 256 -o city.svdag -q
svdag-trace city.svdag --size 48x32 --samples 8 --rounds 1 -j 1 --dump one.bin --picture city.ppm
svdag-trace city.svdag --size 48x32 --samples 8 --rounds 1 -j 2 --no-beams --dump two.bin | grep results
cmp one.bin two.bin
wc -c < one.bin
head -c 15 city.ppm | head -n 2
