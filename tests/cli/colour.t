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

## build_colours
# One command gives the bytes of two, and one file.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o a.svdag -r 128 -q && svdag colour a.svdag cut.glb -o b.svdag -q --colour-error 3
$ svdag build cut.glb -o c.svdag -r 128 --colours --colour-error 3 | sed 's/, [0-9.]* s$//'
| c.svdag: 128^3, 1,350 triangles, 36,069 voxels, 5,318 nodes, 61.8 KiB (14 bits per voxel)
|   41,250 colours down to level 7, 288 bytes (0.0559 bits each), a cube spans 18 texels
|   1,200 triangles are cut out by the alpha of their material
|   colour hash bf92ae9fd3a65c9e06a248ced745e61e
$ cmp b.svdag c.svdag
$ svdag build cut.glb -o c.svdag -r 128 --colours --report r.json -q --layout compact
$ python3 -c 'import json; r = json.load(open("r.json")); c = r["colours"]; print(c["level"], c["count"], c["error"], r["description_hash"] != "")'
| 7 41250 9.0 True
$ echo '[{"scene": "cut.glb", "output": "d.svdag", "resolution": 128, "colours": true}]' > list.json
$ svdag batch list.json --colour-error 3 -q
! svdag: --colour-error requires --colours; see svdag batch --help
? 2
$ svdag batch list.json --colours --colour-error 3 -q && cmp b.svdag d.svdag
$ ls *.scratch
! ls: cannot access '*.scratch': No such file or directory
? 2

## build_colours_refused
$ python3 -B $TESTS/cut_scene.py 20
$ svdag build cut.glb -o a.svdag -r 64 --colour-level 3
! svdag: --colour-level requires --colours; see svdag build --help
? 2
$ svdag build cut.glb -o a.svdag -r 64 --colours --colour-level 7
! svdag: --colour-level 7: choose 3 to 6
? 2
$ svdag build cut.glb -o a.run -r 64 --colours --part 1/2
! svdag: --colours: runs have none: merge them first, then use svdag colour
? 2
$ svdag build cut.glb -o a.svdag -r 64 --colours --layers material --no-union
! svdag: --colours: they belong to the union: leave --no-union and --frames out
? 2
$ ls
| cut.glb
| cut.mtl
| cut.obj
| noisy.png

## colours_of_a_scene_with_broken_corners
# A triangle that is nowhere in its texture has the colour of its material; brighter than white is white.
$ python3 -B $TESTS/broken_paint.py
$ svdag build paint.gltf -o a.svdag -r 64 --colours --colour-level 6 | sed 's/, [0-9.]* s$//'
| a.svdag: 64^3, 4 triangles, 8,192 voxels, 9 nodes, 2.2 KiB (2.2 bits per voxel)
|   8,737 colours down to level 6, 400 bytes (0.366 bits each), a cube spans 0.016 texels
|   1 vertex or face has a colour beyond 1, which is read as 1
|   1 triangle has the colour of the material alone: a texture coordinate is NaN, infinite or beyond 2^40 texels
|   colour hash a04f41ff252a9305d415540e177d8044
$ printf 'v 0 0 0 255 128 0\nv 1 0 0 1 1 1\nv 0 1 0 0 0 0\nf 1 2 3\n' > bright.obj
$ svdag build bright.obj -o b.svdag -r 64 --colours | sed 's/, [0-9.]* s$//'
| b.svdag: 64^3, 1 triangle, 2,143 voxels, 13 nodes, 1.9 KiB (7.2 bits per voxel)
|   47 colours down to level 3, 128 bytes (21.8 bits each), a cube spans 0.13 texels
|   1 vertex or face has a colour beyond 1, which is read as 1
|   colour hash e440028c6acdc7fb0c2fa31b1cd9b84c

## colour_resumes
# There is nothing to resume, and a bake is not a pass.
$ python3 -B $TESTS/cut_scene.py 20
$ svdag build cut.glb -o a.svdag -r 64 -q
$ svdag colour a.svdag cut.glb -o b.svdag --resume | tail -1
|   nothing to resume in b.svdag.scratch: it was made anew
$ svdag-scene scan -n 70K -q -o s.ply
$ svdag build s.ply -r 8K -o b.svdag -q -m 8M &
$ until test -n "$(find . -name journal)"; do sleep 0.02; done
$ sleep 0.1; kill -s KILL $! && wait $! 2>/dev/null || true
$ svdag colour a.svdag cut.glb -o b.svdag
! svdag: b.svdag: an unfinished bake of it is in b.svdag.scratch: continue it with --resume or discard it with --restart
? 2
$ svdag colour a.svdag cut.glb -o b.svdag --resume 2>&1 | sed 's/: .*another one.*/: the unfinished bake is another one/'
| svdag: the unfinished bake is another one
$ svdag colour a.svdag cut.glb -o b.svdag --restart -q
$ ls -d *.scratch
! ls: cannot access '*.scratch': No such file or directory
? 2
