# Frames of an animation: --frames, each a layer of one file.

## frames
# Each is the bake at its time, on the grid of all; every way of baking gives the same bytes.
$ python3 -B $TESTS/moving_scene.py 100
$ svdag build moving.gltf -o a.svdag -r 128 --frames 0:2.5:0.25 -q
$ svdag info a.svdag --layers | tail -14
|   content hash 21650cfb6e074f82dfba7e5c76ea68e4
|
|               voxels          nodes      own nodes  colour   layer
|               11,806            330            298  #599e4f  0.00
|               12,743            519            456  #804f9e  0.25
|               12,952            551            482  #b7aef2  0.50
|               13,096            583            498  #aeb7f2  0.75
|               13,119            573            485  #4f9e9e  1.00
|               13,024            551            482  #d9d96c  1.25
|               13,170            562            493  #6c7ad9  1.50
|               13,178            544            478  #9e4f8a  1.75
|               12,960            527            456  #6d9e4f  2.00
|               13,074            546            474  #d96ccb  2.25
|               13,165            523            455  #9e8a4f  2.50
$ svdag-verify check a.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag-verify mesh a.svdag moving.gltf --frames 0:2.5:0.25 | grep -v "^layer.* 0 missing, 0 extra"
| grid       128^3 box, voxel size 0.022251968665235624, corner (-0.8379419986277178, -0.5871260048175418, -0.8237660083401751), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  220,132
| layers     11 layers agree
| ok: every voxel agrees with the scene
$ cube=--cube=-2,-2,-2,5
$ svdag build moving.gltf -o a.svdag -r 128 $cube --frames 0:10.5:2.625 -q && svdag info a.svdag --layers | tail -5
|                2,904             86             82  #aef2d9  00.000
|                3,285            200              0  #6cb0d9  02.625
|                3,285            200              0  #4f9e9e  05.250
|                3,285            200              0  #4f9e59  07.875
|                3,285            200              0  #4f9e6d  10.500
$ for time in 0 2.625 10.5; do
>   svdag build moving.gltf -o one.svdag -r 128 $cube --time $time -q
>   svdag convert a.svdag -o frame.svdag --layer "$(printf %06.3f $time)" -q
>   svdag-verify diff frame.svdag one.svdag -q && echo "$time: the same"
> done
| 0: the same
| 2.625: the same
| 10.5: the same
$ svdag build moving.gltf -o b.svdag -r 128 $cube --frames 0:10.5:2.625 -m 3M -v | grep -c scratch: && cmp a.svdag b.svdag
| 1
$ svdag plan moving.gltf -o plan -r 128 $cube --frames 0:10.5:2.625 --shards 2 -q && svdag run plan -q && cmp a.svdag plan/plan.svdag
$ for i in 1 2; do svdag build moving.gltf -o $i.run -r 128 $cube --frames 0:10.5:2.625 -q --part $i/2; done
$ svdag info 1.run | grep layers
|   5 layers, one for each frame, without their union
$ svdag merge 1.run 2.run -o b.svdag -q && cmp a.svdag b.svdag
$ for i in 1 2; do svdag build moving.gltf -o b.svdag -r 128 $cube --frames 0:10.5:2.625 -q --cache cells && cmp a.svdag b.svdag; done
$ svdag export a.svdag -o a.npz -q && svdag import a.npz -o b.svdag -q && svdag info b.svdag | grep layers
|   5 layers, one for each frame
$ svdag-verify render a.svdag -o a.png --frames --size 32x18 -q && ls a_*.png
| a_0001.png
| a_0002.png
| a_0003.png
| a_0004.png
| a_0005.png
# A camera of one's own sees what it sees of one frame.
$ svdag-verify render a.svdag -o a.png --frames --camera=3,2,3,0,0,0 --light=3,6,2,1 --size 32x18 -q
$ svdag convert a.svdag -o frame.svdag --layer 02.625 -q && svdag-verify render frame.svdag -o one.png --mode primary --camera=3,2,3,0,0,0 --light=3,6,2,1 --size 32x18 -q && cmp a_0002.png one.png

## frames_of_one_animation
$ python3 -B $TESTS/moving_scene.py 4
$ svdag build moving.gltf -o a.svdag -r 64 --frames 1:2:1 --animation turn --rule thin -q
$ svdag-verify mesh a.svdag moving.gltf --frames 1:2:1 --animation turn
| grid       64^3 box, voxel size 0.03088585709667055, corner (-0.04154911968410044, -0.5914429490332593, -0.7834429081778517), rule thin, matches the scene's bounds
| judge      integer: exact lines of centres
| triangles  88
| layers     2 layers agree
| ok: every voxel agrees with the scene
$ svdag-verify mesh a.svdag moving.gltf --frames 1:2:1 | tail -1
| not ok: file and scene differ
$ svdag-verify mesh a.svdag moving.gltf --frames 1:2:0.5 --animation turn | grep defect
| defect     the scene has nothing named "1", which is a layer
| defect     the scene has nothing named "2", which is a layer
| defect     the file has no layer "1.0"
| defect     the file has no layer "1.5"
| defect     the file has no layer "2.0"
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:0.5 --exclude wave --rule solid -q
$ svdag-verify mesh a.svdag moving.gltf --frames 0:1:0.5 --exclude wave | tail -1
| ok: every voxel agrees with the scene
# A list has frames, too.
$ echo '[{"scene": "moving.gltf", "output": "b.svdag", "frames": "0:1:0.5", "exclude": "wave"}]' > list.json
$ svdag batch list.json -q -r 64 --rule solid --layers material && cmp a.svdag b.svdag

## animations
$ python3 -B $TESTS/moving_scene.py 2
$ svdag info moving.gltf | grep animation
|   animation #0 turn: 2.5 s, moves 1 node, morphs 0
|   animation #1: 2.5 s, moves 1 node, morphs 0
$ svdag info moving.gltf --json | sed -n '/"animations"/,/^  \]/p'
|   "animations": [
|     {
|       "name": "turn",
|       "seconds": 2.5,
|       "nodes": 1,
|       "weights": 0
|     },
|     {
|       "name": "",
|       "seconds": 2.5,
|       "nodes": 1,
|       "weights": 0
|     }
|   ]

## frames_refused
$ python3 -B $TESTS/moving_scene.py 2
$ for frames in 1:0:1 0:1:0 0:1 0:1:1:1 -1:0:1 0:1e3:1 0:99:0.001 .5:1:1 0:1:1. 0:1234567890:1; do svdag build moving.gltf -o a.svdag -r 64 --frames=$frames 2>&1 || echo "exit $?"; done
| svdag: --frames: "1:0:1" ends before it begins
| exit 2
| svdag: --frames: "0:1:0" has a step of 0
| exit 2
| svdag: --frames: "0:1" is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
| svdag: --frames: "0:1:1:1" is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
| svdag: --frames: "-1:0:1" is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
| svdag: --frames: "0:1e3:1" is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
| svdag: --frames: "0:99:0.001" has 99,001 frames: a file has at most 65,535 layers
| exit 2
| svdag: --frames: ".5:1:1" is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
| svdag: --frames: "0:1:1." is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
| svdag: --frames: "0:1234567890:1" is not A:B:STEP in seconds, for example 0:2.5:0.1, of at most 9 digits before and after the point
| exit 2
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:1 --time 1
! svdag: --time: --frames has the times: give one
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:1 --layers object
! svdag: --layers: the layers of --frames are its times
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --layers frame
! svdag: --layers: unknown kind "frame": choose material, object or file
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --animation turn
! svdag: --animation needs the time of a pose: give --time, too
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --time 1s
! svdag: --time: "1s" is not a number of seconds
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:1 --rule solid
! svdag: the scene is not closed: 13 open edges in wave, the first at (0, 0, 0): repair it
? 3
# Modulo 2, the open edges of two frames cancel each other.
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:1 --rule solid --inside odd --animation '#1'
! svdag: the scene is not closed at 2 of its frames: repair it
? 3
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:1 --rule solid --open surface
! svdag: --open surface: every frame has to be closed: give --rule conservative or thin
? 2
$ svdag-scene speck -n 100 -q -o s.ply
$ svdag build s.ply -o a.svdag -r 64 --frames 0:1:1
! svdag: s.ply: --frames: svdag follows only animations of glTF
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --frames 0:1:1 -q
$ svdag-verify mesh a.svdag moving.gltf
! svdag-verify: a.svdag: its layers are frames: give --frames
? 2
$ svdag build moving.gltf -o a.svdag -r 64 --layers object -q
$ svdag-verify mesh a.svdag moving.gltf --frames 0:1:1
! svdag-verify: --frames: the layers of a.svdag are not frames
? 2
