# svdag-verify render.

## verify_render
$ svdag-scene city -n 1.2K -q -o city.ply
$ svdag build city.ply -r 64 -o city.svdag -q
$ svdag-verify render city.svdag -o city.png --size 64x48 -q
$ head -c 8 city.png | od -An -tx1
|  89 50 4e 47 0d 0a 1a 0a

## verify_render_bad_mode
$ svdag-scene speck -n 8 -q -o a.ply
$ svdag build a.ply -r 16 -o a.svdag -q
$ svdag-verify render a.svdag -o a.png --mode x-ray
! svdag-verify: --mode: "x-ray" is not primary, shadow, soft, ao, normal, depth, level, steps or colour
? 2

## verify_render_bad_preset
$ svdag-scene speck -n 8 -q -o a.ply
$ svdag build a.ply -r 16 -o a.svdag -q
$ svdag-verify render a.svdag -o a.png --preset below
! svdag-verify: --preset: "below" is not one of iso, front, back, left, right, top, inside; see svdag-verify render --help
? 2

## verify_render_clip
# --clip and --slice show a part of the voxels, with sections in red.
$ svdag-scene city -n 1.2K -q -o city.ply
$ svdag build city.ply -r 64 -o city.svdag -q
$ svdag-verify render city.svdag -o whole.png --size 80x60 -q
$ svdag-verify render city.svdag -o slice.png --size 80x60 --slice x=0 -q
$ svdag-verify render city.svdag -o clip.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode soft --samples 2 -q
$ python3 "$TESTS"/colours.py whole.png slice.png clip.png
| whole.png
| slice.png red
| clip.png red
$ svdag-verify render city.svdag -o one.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode ao --samples 2 -q -j 1
$ svdag-verify render city.svdag -o two.png --size 80x60 --clip=-30,-1,-30,20,50,20 --mode ao --samples 2 -q -j 2
$ cmp one.png two.png
# Pictures of data have no section colour: a depth is grey everywhere.
$ svdag-verify render city.svdag -o depth.png --size 80x60 --slice x=0 --mode depth -q
$ python3 "$TESTS"/colours.py depth.png
| depth.png
$ for option in --slice=x=9e9 --slice=x --slice=w=1 --slice=x=nan --clip=1e6,1e6,1e6,2e6,2e6,2e6 --clip=1,2,3; do
>   svdag-verify render city.svdag -o bad.png $option || echo "exit $?"
> done
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
| exit 2
! svdag-verify: --slice x=9e9: the plane does not cut the voxels that are shown
! svdag-verify: --slice: "x" is not an axis and a position, such as z=1.5
! svdag-verify: --slice: "w=1" is not an axis and a position, such as z=1.5
! svdag-verify: --slice: "x=nan" is not an axis and a position, such as z=1.5
! svdag-verify: --clip: contains no voxel of the grid
! svdag-verify: --clip: "1,2,3" is not x0,y0,z0,x1,y1,z1 with the minimum first
$ ls *.png
| clip.png
| depth.png
| one.png
| slice.png
| two.png
| whole.png

## verify_render_cone
# A cone's half angle is not negative; 0 is a value of its own, not the default.
$ svdag-scene speck -n 8 -q -o a.ply
$ svdag build a.ply -r 16 -o a.svdag -q
$ for cone in -1 -2 45 nan; do
>   svdag-verify render a.svdag -o a.png --mode ao --cone=$cone || echo "exit $?"
> done
| exit 2
| exit 2
| exit 2
| exit 2
! svdag-verify: --cone: "-1" is not an angle from 0 to less than 45 degrees
! svdag-verify: --cone: "-2" is not an angle from 0 to less than 45 degrees
! svdag-verify: --cone: "45" is not an angle from 0 to less than 45 degrees
! svdag-verify: --cone: "nan" is not an angle from 0 to less than 45 degrees
$ svdag-verify render a.svdag -o a.png --mode ao --cone 0 --size 8x8
| a.png: 8x8, ao

## verify_render_modes
$ svdag-scene city -n 1.2K -q -o city.ply
$ svdag build city.ply -r 256 -o city.svdag -q
$ for mode in primary shadow soft ao normal depth level steps; do
>   svdag-verify render city.svdag -o $mode.png --mode $mode --size 40x30 --samples 4
> done
| primary.png: 40x30, primary
| shadow.png: 40x30, shadow
| soft.png: 40x30, soft
| ao.png: 40x30, ao
| normal.png: 40x30, normal
| depth.png: 40x30, depth
| level.png: 40x30, level
| steps.png: 40x30, steps
$ for view in front back left right top inside; do
>   svdag-verify render city.svdag -o $view.png --preset $view --size 40x30 -q --level 5
> done
$ svdag-verify render city.svdag -o turn.png --size 20x15 --supersample 1 --fly 3
| turn_0001.png: 20x15, primary
| turn_0002.png: 20x15, primary
| turn_0003.png: 20x15, primary
$ svdag-verify render city.svdag -o one.png --mode soft --size 40x30 -j 1 -q
$ svdag-verify render city.svdag -o two.png --mode soft --size 40x30 -j 2 -q
$ cmp one.png two.png
$ cmp -s front.png back.png
? 1
$ ls *.png | wc -l
| 19

## verify_render_in_matter
# A camera in a voxel is reported; what is cut away is not in the way.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nf 1 2 3\n' > a.obj
$ svdag build a.obj -o a.svdag -s 1 --origin 0,0,0 -q
$ svdag-verify render a.svdag -o a.png --size 32x18 --camera=1.5,1.5,0.5,9,9,9 -q
! svdag-verify: the camera is in matter: voxel 17, 17, 16 is all that it sees
$ svdag-verify render a.svdag -o a.png --size 32x18 --camera=1.5,1.5,0.5,9,9,9 --clip=3,0,-1,8,8,1 -q
$ svdag-verify render a.svdag -o a.png --size 32x18 --camera=1.5,1.5,1.5,9,9,9 -q
