# --render draws voxels of both files grey, of only A red, of only B blue.
svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 64 --cube=-60,-60,-60,120 -o a.svdag -q
svdag edit a.svdag -o half.svdag --bounds=-60,-60,-60,0,60,60 -q
svdag-verify diff a.svdag a.svdag --render same.png --size 80x60 -q
svdag-verify diff a.svdag half.svdag --render less.png --size 80x60 -q || echo "exit $?"
svdag-verify diff half.svdag a.svdag --render more.png --size 80x60 -q || echo "exit $?"
python3 "$TESTS"/colours.py same.png less.png more.png
svdag edit a.svdag -o coarse.svdag --level 5 -q
svdag-verify diff a.svdag coarse.svdag --render bad.png || echo "exit $?"
svdag-verify diff a.svdag half.svdag --render bad.jpg || echo "exit $?"
svdag-verify diff a.svdag half.svdag --render a.svdag || echo "exit $?"
svdag-verify diff a.svdag half.svdag --render bad.png --size 0x0 || echo "exit $?"
ls
svdag build city.ply -r 64 --cube=500,500,500,1 -o none.svdag -q
svdag-verify diff none.svdag none.svdag --render bad.png || echo "exit $?"
