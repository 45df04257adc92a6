# --clip and --slice show a part of the voxels, with sections in red.
svdag-scene city -n 1.2K -q -o city.ply
svdag build city.ply -r 64 -o city.svdag -q
svdag-verify render city.svdag -o whole.png --size 80x60 -q
svdag-verify render city.svdag -o slice.png --size 80x60 --slice x=0 -q
svdag-verify render city.svdag -o clip.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode soft --samples 2 -q
python3 "$TESTS"/colours.py whole.png slice.png clip.png
svdag-verify render city.svdag -o one.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode ao --samples 2 -q -j 1
svdag-verify render city.svdag -o two.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode ao --samples 2 -q -j 2
cmp one.png two.png
# Pictures of data have no section colour: a depth is grey everywhere.
svdag-verify render city.svdag -o depth.png --size 80x60 --slice x=0 --mode depth -q
python3 "$TESTS"/colours.py depth.png
for option in --slice=x=9e9 --slice=x --slice=w=1 --slice=x=nan --clip=1e6,1e6,1e6,2e6,2e6,2e6 --clip=1,2,3; do
  svdag-verify render city.svdag -o bad.png $option || echo "exit $?"
done
ls *.png
