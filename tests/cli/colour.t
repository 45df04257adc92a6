# svdag colour: the colours of a scene for a finished .svdag.

## colour
# Threads, memory and earlier colours make no difference.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o a.svdag -r 128 -q
$ svdag colour a.svdag cut.glb -o c.svdag -j 1 | grep -v hash
| c.svdag: 41,250 colours down to level 7, 288 bytes (0.0559 bits each), a cube spans 18 texels
|   1,200 triangles are cut out by the alpha of their material
$ svdag colour a.svdag cut.glb -o d.svdag -q -j 2 && cmp c.svdag d.svdag
$ svdag colour a.svdag cut.glb -o d.svdag -q -m 24M && cmp c.svdag d.svdag
$ svdag colour c.svdag cut.glb -o d.svdag -q && cmp c.svdag d.svdag
$ svdag convert c.svdag --no-colours -o d.svdag -q && cmp a.svdag d.svdag
$ ls
| a.svdag
| c.svdag
| cut.glb
| cut.mtl
| cut.obj
| d.svdag
| noisy.png

## colours_refused
# The old file stays.
$ python3 -B $TESTS/cut_scene.py 20
$ svdag build cut.glb -o a.svdag -r 64 -q && cp a.svdag c.svdag
$ python3 -B $TESTS/cut_scene.py 10
$ svdag colour a.svdag cut.glb -o c.svdag
! svdag: a.svdag: does not belong to this scene: on axis z its voxels reach from 0 to 63, the scene from 1 to 63
? 3
$ cmp a.svdag c.svdag
$ svdag colour a.svdag cut.glb -o c.svdag --colour-level 9
! svdag: --colour-level 9: choose 3 to 6
? 2
$ svdag colour a.svdag cut.glb -o a.svdag
! svdag: a.svdag is also an input, which is never overwritten: choose another output
? 2

## colours_of_a_foreign_scene_of_one_colour
# Its bounds are those of the cube, whose faces it does not have.
$ printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 1 2 3 4\nf 5 6 7 8\nf 1 2 6 5\nf 4 3 7 8\nf 1 4 8 5\nf 2 3 7 6\n' > cube.obj
$ printf 'v 0 0 0\nv 1 1 1\nv 0 1 .5\nf 1 2 3\n' > triangle.obj
$ svdag build cube.obj -o a.svdag -r 256 -q
$ svdag colour a.svdag cube.obj -o b.svdag -q
$ svdag colour a.svdag triangle.obj -o b.svdag
! svdag: a.svdag: does not belong to this scene: 388,066 of its cubes have no triangle: give the scene, options and pose that it was built with
? 3

## colours_of_a_solid_that_ends_at_its_bounds
# Where it has no triangle, it has no colour.
$ printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nf 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 8 7 3 4\nf 1 5 8 4\nf 2 3 7 6\n' > cube.obj
$ svdag build cube.obj -o a.svdag -r 128 --rule solid --bounds 0.2,0.2,0.2,0.8,0.8,0.8 -q
$ svdag colour a.svdag cube.obj -o b.svdag | head -1
| b.svdag: 2,130,440 colours down to level 7, 16 bytes (6.01e-05 bits each)
$ svdag build cube.obj -o a.svdag -r 128 --rule solid --bounds 0.5,0.2,0.2,1.1,0.8,0.8 -q
$ svdag colour a.svdag cube.obj -o b.svdag | head -1
| b.svdag: 1,781,192 colours down to level 7, 8.3 KiB (0.0382 bits each)

## colours_with_more_threads_than_memory
# The encoders take what is left; a compact file stays compact without its colours.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o a.svdag -r 128 -q --layout compact
$ svdag colour a.svdag cut.glb -o b.svdag -q -j 64 -m 64M
$ svdag colour a.svdag cut.glb -o c.svdag -q -j 1 && cmp b.svdag c.svdag
$ svdag convert b.svdag -o c.svdag -q --no-colours && cmp a.svdag c.svdag
