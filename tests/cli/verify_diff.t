# svdag-verify diff.

## verify_diff_coarser
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag build a.ply -r 512 -o fine.svdag -q
$ svdag build a.ply -r 256 -o coarse.svdag -q
$ svdag-verify diff fine.svdag coarse.svdag --show 0 --json
| {"command":"diff","a":"fine.svdag","b":"coarse.svdag","resolution":256,"pairs":4608,"both":215303,"only_a":21000,"only_b":20138,"clusters":3,"largest_clusters":[{"only_a":20997,"only_b":20137,"bounds":[-42.34844755706489,-48.27107023772895,-45.21941923675239,35.095282567690504,59.476728196713324,38.95854829015563]},{"only_a":2,"only_b":0,"bounds":[16.576129711770733,34.22333793864091,17.072276733159555,18.259689062308894,35.90689728917907,20.439395434235877]},{"only_a":1,"only_b":1,"bounds":[16.576129711770733,39.27401599025539,13.705158032083233,19.943248412847055,40.957575340793554,15.388717382621394]}],"first":[],"same":false}
? 1

## verify_diff_different
# The thin voxels are a subset of the conservative ones: nothing is only in the thin file.
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag build a.ply -r 128 -o whole.svdag -q
$ svdag build a.ply -r 128 --rule thin -o thin.svdag -q
$ svdag-verify diff thin.svdag whole.svdag --show 3 --write-diff d.ply
| compared  at 128^3, 1,068 pairs of nodes
| both      33,448 voxels
| only A    0
| only B    24,601
| clusters  1
| cluster   0 voxels only A, 24,601 only B, in (-42.6666005, -48.5892232, -45.5375722) to (35.2344745, 59.7948811, 39.1375093)
| only B    voxel (25, 21, 31)
| only B    voxel (25, 22, 31)
| only B    voxel (26, 20, 31)
| different
? 1
$ svdag-verify diff thin.svdag whole.svdag -q --write-diff d.ply --write-most 10
! svdag-verify: d.ply: would get 24601 points, --write-most is 10: raise --write-most
? 2
$ svdag-verify diff thin.svdag whole.svdag -q --write-diff d.vdb
! svdag-verify: d.vdb: the difference is written as a .ply
? 2

## verify_diff_elsewhere
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag-scene city -n 5K -q -o c.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag build c.ply -r 64 -o c.svdag -q
$ svdag-verify diff a.svdag c.svdag
! svdag-verify: a.svdag and c.svdag have grids in different places, corner (-43.0966962, -49.0193188, -45.9676678), side 109.244296 and corner (-48.7619048, -1.76190476, -48.7619048), side 97.5238095: to compare them by voxel index add --by-index
? 2

## verify_diff_moved
# A cube, shifted by less than a voxel and slightly enlarged: the same indices at other positions.
$ cube() {
>   printf 'OFF\n8 6 0\n'
>   for x in $1 $2; do for y in 0 $3; do for z in 0 $3; do echo $x $y $z; done; done; done
>   printf '4 0 1 3 2\n4 4 6 7 5\n4 0 4 5 1\n4 2 3 7 6\n4 0 2 6 4\n4 1 5 7 3\n'
> }
$ cube 0 1 1 > cube.off
$ cube 0.0009 1.0009 1 > moved.off
$ cube 0 1.0005 1.0005 > larger.off
$ for name in cube moved larger; do svdag build $name.off -r 1K -o $name.svdag -q; done
$ svdag build cube.off -r 512 -o half.svdag -q
$ svdag build moved.off -r 512 -o half_moved.svdag -q
$ for name in cube moved larger half half_moved; do
>   echo $name
>   svdag-verify diff cube.svdag $name.svdag -q || echo "exit $?"
>   svdag-verify diff $name.svdag cube.svdag -q --by-index || echo "exit $?"
> done
| cube
| moved
| exit 2
| larger
| exit 2
| half
| half_moved
| exit 2
! svdag-verify: cube.svdag and moved.svdag have grids in different places, corner (-0.000488758553, -0.000488758553, -0.000488758553), side 1.00097752 and corner (0.000411241447, -0.000488758553, -0.000488758553), side 1.00097752: to compare them by voxel index add --by-index
! svdag-verify: cube.svdag and larger.svdag have grids in different places, corner (-0.000488758553, -0.000488758553, -0.000488758553), side 1.00097752 and corner (-0.000489002933, -0.000489002933, -0.000489002933), side 1.00147801: to compare them by voxel index add --by-index
! svdag-verify: cube.svdag and half_moved.svdag have grids in different places, corner (-0.000488758553, -0.000488758553, -0.000488758553), side 1.00097752 and corner (-7.84735812e-05, -0.000978473581, -0.000978473581), side 1.00195695: to compare them by voxel index add --by-index
# Formats that store the position as float32 are at the same position; so is a level of the grid.
$ svdag export moved.svdag --format symvox -o other.svdag -q
$ svdag import other.svdag -o back.svdag -q
$ svdag-verify diff back.svdag moved.svdag
| compared  at 1K^3, 165 pairs of nodes
| both      6,279,176 voxels
| only A    0
| only B    0
| clusters  0
| same
$ svdag export moved.svdag -o level.npz -q --level 8
$ svdag import level.npz -o level.svdag -q
$ svdag-verify diff moved.svdag level.svdag
| compared  at 256^3, 113 pairs of nodes
| both      390,152 voxels
| only A    0
| only B    0
| clusters  0
| same

## verify_diff_render
# --render draws voxels of both files grey, of only A red, of only B blue.
$ svdag-scene city -n 1.2K -q -o city.ply
$ svdag build city.ply -r 64 --cube=-60,-60,-60,120 -o a.svdag -q
$ svdag edit a.svdag -o half.svdag --bounds=-60,-60,-60,0,60,60 -q
$ svdag-verify diff a.svdag a.svdag --render same.png --size 80x60 -q
$ svdag-verify diff a.svdag half.svdag --render less.png --size 80x60 -q
? 1
$ svdag-verify diff half.svdag a.svdag --render more.png --size 80x60 -q
? 1
$ python3 "$TESTS"/colours.py same.png less.png more.png
| same.png
| less.png red
| more.png blue
$ svdag edit a.svdag -o coarse.svdag --level 5 -q
$ svdag-verify diff a.svdag coarse.svdag --render bad.png
! svdag-verify: --render: needs files of equal resolution: coarsen one with svdag edit --level
? 2
$ svdag-verify diff a.svdag half.svdag --render bad.jpg
! svdag-verify: bad.jpg: pictures are PNG: choose a name in .png
? 2
$ svdag-verify diff a.svdag half.svdag --render a.svdag
! svdag-verify: a.svdag is also an input, which is never overwritten: choose another output
? 2
$ svdag-verify diff a.svdag half.svdag --render bad.png --size 0x0
! svdag-verify: --size: "0x0" is not WIDTHxHEIGHT with 1 to 16384 pixels each
? 2
$ ls
| a.svdag
| city.ply
| coarse.svdag
| half.svdag
| less.png
| more.png
| same.png
$ svdag build city.ply -r 64 --cube=500,500,500,1 -o none.svdag -q
$ svdag-verify diff none.svdag none.svdag --render bad.png
! svdag-verify: --render: neither file has a voxel
? 2

## verify_diff_same
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag build a.ply -r 512 -o a.svdag -q
$ svdag build a.ply -r 512 -o b.svdag -q -m 16M -j 1
$ svdag-verify diff a.svdag b.svdag
| compared  at 512^3, 17,732 pairs of nodes
| both      947,906 voxels
| only A    0
| only B    0
| clusters  0
| same

## verify_diff_layers
# A line for each layer that differs; JSON has all.
$ svdag-scene atrium -o a.obj -q
$ svdag build a.obj -o a.svdag -r 64 --layers material -q
$ svdag build a.obj -o b.svdag -r 64 --layers material -q --exclude material:vase --allow-empty
$ svdag-verify diff a.svdag a.svdag
| compared  at 64^3, 136 pairs of nodes
| both      20,739 voxels
| only A    0
| only B    0
| layers    9 layers agree
| clusters  0
| same
$ svdag-verify diff a.svdag b.svdag --show 0
| compared  at 64^3, 136 pairs of nodes
| both      20,684 voxels
| only A    55
| only B    0
| layer     vase, 0 in both, 119 only A, 0 only B
| layers    8 layers agree
| clusters  10
| cluster   10 voxels only A, 0 only B, in (-12.2666713, -0.755555652, -4.76667132) to (-8.17778088, 1.28888957, -0.677780878)
| cluster   8 voxels only A, 0 only B, in (8.17778088, -0.755555652, 1.36666434) to (12.2666713, 1.28888957, 5.45555478)
| cluster   6 voxels only A, 0 only B, in (-8.17778088, -0.755555652, 1.36666434) to (-6.13333566, 1.28888957, 5.45555478)
| cluster   6 voxels only A, 0 only B, in (10.2222261, -0.755555652, -4.76667132) to (12.2666713, 1.28888957, -0.677780878)
| cluster   5 voxels only A, 0 only B, in (6.13333566, -0.755555652, -4.76667132) to (8.17778088, 1.28888957, -2.7222261)
| cluster   5 voxels only A, 0 only B, in (4.08889044, -0.755555652, 1.36666434) to (6.13333566, 1.28888957, 5.45555478)
| cluster   4 voxels only A, 0 only B, in (-12.2666713, -0.755555652, 1.36666434) to (-10.2222261, 1.28888957, 3.41110956)
| cluster   4 voxels only A, 0 only B, in (-6.13333566, -0.755555652, -4.76667132) to (-4.08889044, 1.28888957, -2.7222261)
| cluster   4 voxels only A, 0 only B, in (-2.04444522, -0.755555652, 1.36666434) to (0, 1.28888957, 5.45555478)
| cluster   3 voxels only A, 0 only B, in (0, -0.755555652, -4.76667132) to (2.04444522, 1.28888957, -2.7222261)
| different
? 1
$ svdag-verify diff a.svdag b.svdag --json | tr '{' '\n' | grep -c both
| 10
$ svdag-verify mesh b.svdag a.obj
| grid       64^3 box, voxel size 0.5111113048735119, corner (-16.35556175595238, -0.7555556524367559, -8.855561755952381), rule conservative, matches the scene's bounds
| defect     the file has no layer "vase"
| judge      integer: exact clipping
| triangles  256,700
| bricks     688 (all), 19 wrong
| voxels     20,684 in the file, 20,739 by the judge
| missing    55
| extra      0
|   missing  voxel (9, 2, 10) at (-11.5000044, 0.52222261, -3.48889305)
|   missing  voxel (9, 2, 11) at (-11.5000044, 0.52222261, -2.97778175)
|   missing  voxel (10, 2, 9) at (-10.9888931, 0.52222261, -4.00000436)
|   missing  voxel (11, 2, 9) at (-10.4777817, 0.52222261, -4.00000436)
|   missing  voxel (10, 2, 10) at (-10.9888931, 0.52222261, -3.48889305)
|   missing  voxel (11, 2, 11) at (-10.4777817, 0.52222261, -2.97778175)
|   missing  voxel (9, 2, 12) at (-11.5000044, 0.52222261, -2.46667045)
|   missing  voxel (10, 2, 12) at (-10.9888931, 0.52222261, -2.46667045)
| layers     8 layers agree
| not ok: file and scene differ
? 1

## verify_diff_many_layers
# The time grows with the layers, not with their square.
$ awk 'BEGIN { for (i = 0; i < 65000; i++) { x = i % 41; y = int(i / 41) % 41; z = int(i / 1681)
>   printf "o part%d\nv %g %g %g\nv %g %g %g\nv %g %g %g\nf -3 -2 -1\n", i, x, y, z, x + .5, y, z, x, y + .5, z } }' > many.obj
$ svdag build many.obj -o a.svdag -r 256 --layers object -q
$ cp a.svdag b.svdag
$ (ulimit -t 6; svdag-verify diff a.svdag b.svdag) | tail -n 1
| same
$ (ulimit -t 30; svdag-verify report a.svdag -o a.html -q -j 1 --size 64x36)
$ [ $(stat -c %s a.html) -lt 4800000 ]
