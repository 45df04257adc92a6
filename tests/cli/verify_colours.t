# svdag-verify colours.

## verify_colours
# What is transparent colours nothing.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o a.svdag -r 128 --colours --colour-error 0 -q
$ svdag-verify colours a.svdag cut.glb
| grid        128^3 box, voxel size 0.17552473413662648, corner (-10.808023940859817, -10.970903884707473, -11.454221259890579), rule conservative, matches the scene's bounds
| judge       points on the triangles, textures by libpng and libjpeg-turbo
| triangles   1,350
| colours     of level 7, stored within 0 of 255 steps
| cubes       36,069 covered, 10,000 drawn, 9,981 judged
|   left out  19 that triangles only touch, 0 without a triangle or a colour
| difference  mean 0.000, 99.9 % 0, largest 0 steps of sRGB
|   at seams  mean 0.000, 111 cubes
| allowed     mean 1.43 steps
| wrong       0 cubes
| ok: no drawn cube has a colour that its triangles do not have
$ svdag-verify colours a.svdag cut.glb --sample 100 --seed 7 --json
|* {"command":"colours",*"level":7,"error":0.0,"covered":36069,"drawn":100,*"wrong":0,"worst":*,"ok":true}
$ svdag build cut.glb -o b.svdag -r 128 --colours --no-cutouts -q
$ svdag-verify colours b.svdag cut.glb --no-cutouts -q

## verify_colours_of_another_scene
# One corner is blue instead of green, and every voxel of its triangle a little.
$ printf 'v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\nv 0 1 0 1 1 1\nf 1 2 3\nf 1 3 4\n' > green.obj
$ sed 's/0 1 0$/0 0 1/' green.obj > blue.obj
$ svdag build green.obj -o a.svdag -r 16 --colours --colour-error 0 -q
$ svdag-verify colours a.svdag green.obj
| grid        16^3 box, voxel size 0.06666666666666667, corner (-0.03333333333333333, -0.03333333333333333, -0.03333333333333333), rule conservative, matches the scene's bounds
| judge       points on the triangles, textures by libpng and libjpeg-turbo
| triangles   2
| colours     of level 3, stored within 0 of 255 steps
| cubes       64 covered, 64 drawn, 64 judged
|   left out  0 that triangles only touch, 0 without a triangle or a colour
| difference  mean 0.016, 99.9 % 1, largest 1 steps of sRGB
|   at seams  mean 0.000, 0 cubes
| allowed     mean 1.07 steps
| wrong       0 cubes
| ok: no drawn cube has a colour that its triangles do not have
$ svdag-verify colours a.svdag blue.obj --sample 6
| grid        16^3 box, voxel size 0.06666666666666667, corner (-0.03333333333333333, -0.03333333333333333, -0.03333333333333333), rule conservative, matches the scene's bounds
| judge       points on the triangles, textures by libpng and libjpeg-turbo
| triangles   2
| colours     of level 3, stored within 0 of 255 steps
| cubes       64 covered, 6 drawn, 6 judged
|   left out  0 that triangles only touch, 0 without a triangle or a colour
| difference  mean 45.278, 99.9 % 198, largest 198 steps of sRGB
|   at seams  mean 0.000, 0 cubes
| allowed     mean 1.06 steps
| wrong       6 cubes
|   wrong     cube (7, 4, 0), #b0c600, the scene has #b000c6, 197.2 steps beyond what is allowed
|   wrong     cube (3, 6, 0), #c6ebaa, the scene has #c6aaeb, 64.3 steps beyond what is allowed
|   wrong     cube (2, 0, 0), #f93f00, the scene has #f9003f, 62.0 steps beyond what is allowed
|   wrong     cube (2, 6, 0), #daebc1, the scene has #dac1eb, 41.3 steps beyond what is allowed
|   wrong     cube (1, 6, 0), #ebebd5, the scene has #ebd5eb, 21.3 steps beyond what is allowed
|   wrong     cube (0, 1, 0), #f97160, the scene has #f96072, 16.4 steps beyond what is allowed
| not ok: file and scene differ
? 1
$ svdag-verify colours a.svdag blue.obj -q
? 1

## verify_colours_refused
$ printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n' > square.obj
$ head -5 square.obj > half.obj
$ svdag build square.obj -o plain.svdag -r 16 -q
$ svdag-verify colours plain.svdag square.obj
! svdag-verify: plain.svdag: has no colours: add them with svdag colour
? 2
$ svdag colour plain.svdag square.obj -o a.svdag -q
$ svdag-verify colours a.svdag half.obj
! svdag-verify: a.svdag: does not belong to this scene: 105 of 256 drawn cubes have no triangle: give the scene, options and pose that it was built with
? 3
$ svdag-verify colours a.svdag square.obj --sample 0
! svdag-verify: --sample: give at least one
? 2
