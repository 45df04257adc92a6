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
