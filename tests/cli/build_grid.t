# The grid of a bake: resolution, voxel size, bounds, cube, origin, units and transforms.

## build_bad_bounds
$ svdag build r.ply -r 64 --bounds=1,1,1,0,0,0 -o r.svdag
! svdag: --bounds: "1,1,1,0,0,0" is not x0,y0,z0,x1,y1,z1 with the minimum first
? 2

## build_bad_resolution
$ svdag build r.ply -r 1000 -o r.svdag
! svdag: --resolution: 1000 is not a power of two: choose 512 or 1K
? 2

## build_bad_voxel_size
$ svdag-scene rectangle -q -o r.ply
$ for size in 0 -1 nan inf 1e-310; do
>   code=0
>   svdag build r.ply "--voxel-size=$size" -o r.svdag || code=$?
>   echo "$size: $code"
> done
| 0: 2
| -1: 2
| nan: 2
| inf: 2
| 1e-310: 2
! svdag: --voxel-size: 0 is not a size
! svdag: the voxel size would be -1, which is not a positive normal number: give --voxel-size or --bounds
! svdag: the voxel size would be nan, which is not a positive normal number: give --voxel-size or --bounds
! svdag: the voxel size would be inf, which is not a positive normal number: give --voxel-size or --bounds
! svdag: the voxel size would be 1e-310, which is not a positive normal number: give --voxel-size or --bounds
$ ls
| r.ply

## build_cube
# --cube: grids of one cube line up; from 64K on the coarser ones are the parents of the finer ones.
$ svdag-scene speck -n 300 -q -o s.ply
$ for r in 1K 64K 256K 1M; do svdag build s.ply -r $r --cube=-70,-70,-70,140 -q -o $r.svdag; done
$ svdag info 1K.svdag | head -3
| 1K.svdag: 1K^3 voxels, rule conservative
|   voxel size 0.13671875, corner (-70, -70, -70), restricted by --bounds or --cube
|   occupied: voxels 43 .. 980, 43 .. 980, 43 .. 980; (-64.1210938, -64.1210938, -64.1210938) to (64.1210938, 64.1210938, 64.1210938)
$ svdag-verify mesh 1K.svdag s.ply | grep '^missing\|^extra\|^ok'
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag-verify diff 64K.svdag 256K.svdag -q && svdag-verify diff 256K.svdag 1M.svdag -q && echo nested
| nested
$ svdag build s.ply -r 64 --cube=-70,-70,-70,140 --bounds=-5,-5,-5,30,30,30 -q -o part.svdag && svdag info part.svdag | sed -n 2p
|   voxel size 2.1875, corner (-70, -70, -70), restricted by --bounds or --cube
$ svdag plan s.ply -r 1K --cube=-70,-70,-70,140 --shards 2 -o plan -q && svdag run plan -q -j 1 && cmp plan/plan.svdag 1K.svdag
# below 64K voxels may differ where a triangle is within the snap of a voxel plane; this scene has no such triangle
$ for r in 2K 4K 8K 16K 32K; do svdag build s.ply -r $r --cube=-70,-70,-70,140 -q -o $r.svdag; done
$ for p in "1K 2K" "2K 4K" "4K 8K" "8K 16K" "16K 32K" "32K 64K"; do set -- $p; svdag-verify diff $1.svdag $2.svdag -q && echo "$1 is half of $2"; done
| 1K is half of 2K
| 2K is half of 4K
| 4K is half of 8K
| 8K is half of 16K
| 16K is half of 32K
| 32K is half of 64K
$ svdag build s.ply -s 1 --cube=0,0,0,1 -o x.svdag
! svdag: --cube: the cube is divided by --resolution: give -r instead of -s
? 2
$ svdag build s.ply -r 64 --cube=0,0,0 -o x.svdag
! svdag: --cube: "0,0,0" is not x,y,z,side with a side of more than 0
? 2
$ svdag build s.ply -r 64 --cube=0,0,0,0 -o x.svdag
! svdag: --cube: "0,0,0,0" is not x,y,z,side with a side of more than 0
? 2

## build_cube_nests
# Resolutions of one --cube nest exactly from 64K on (conservative): the parents of the finer grid are the coarser one.
# Below, at most the voxels within the snap of a plane differ; in this scene none does.
$ python3 - <<'PY'
> import random
> random.seed(16)
> with open("soup.obj", "w") as file:
>     for i in range(60):
>         centre = [random.random() for _ in range(3)]
>         size = 10 ** random.uniform(-5, -2)
>         for _ in range(3):
>             file.write("v %.17g %.17g %.17g\n" % tuple(c + random.uniform(-size, size) for c in centre))
>         file.write("f -3 -2 -1\n")
> PY
$ for pair in "1K 2K 10" "8K 16K 13" "32K 64K 15" "64K 128K 16" "128K 256K 17" "256K 512K 18" "512K 1M 19"; do
>   set -- $pair
>   svdag build soup.obj -o coarse.svdag -r $1 --cube=-0.1,-0.1,-0.1,1.3 -q
>   svdag build soup.obj -o fine.svdag -r $2 --cube=-0.1,-0.1,-0.1,1.3 -q
>   svdag edit fine.svdag -o parents.svdag --level $3 -q
>   svdag-verify diff coarse.svdag parents.svdag > difference || true
>   echo "$1 and $2: $(tail -1 difference)"
> done
| 1K and 2K: same
| 8K and 16K: same
| 32K and 64K: same
| 64K and 128K: same
| 128K and 256K: same
| 256K and 512K: same
| 512K and 1M: same

## build_no_grid
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -o r.svdag
! svdag: give one of --resolution or --voxel-size; see svdag build --help
? 2

## build_origin
# --origin: a corner of voxels is there, planes are whole steps from it, and bakes with one origin agree voxel by voxel.
$ svdag-scene city -n 6K -q -o a.ply
$ svdag build a.ply -o a.svdag -s 0.3 --origin 0.1,-7,1e3 -q
$ svdag info a.svdag | grep -v hash | head -4
| a.svdag: 512^3 voxels, rule conservative
|   voxel size 0.3, corner (-76.7, -7, -75.20000000000005)
|   occupied: voxels 95 .. 415, 19 .. 78, 90 .. 410; (-48.2, -1.3, -48.2) to (48.1, 16.7, 48.1)
|   606,439 voxels set, 176,963 SVO nodes, 4,146 DAG nodes (4,187 with 2x2x2 leaves)
$ svdag-verify check a.svdag
| grid    512^3 origin, voxel size 0.3, corner (-76.7, -7, -75.20000000000005), rule conservative
| bytes   99,216 in 2 blocks, all checksums match
| nodes   4,146 on 8 levels, 460 of them bricks
| voxels  606,439
| ok: sound, in canonical order and minimal
$ svdag-verify mesh a.svdag a.ply | head -1
| grid       512^3 origin, voxel size 0.3, corner (-76.7, -7, -75.20000000000005), rule conservative, matches the scene's bounds
$ svdag-verify mesh a.svdag a.ply | tail -1
| ok: every voxel agrees with the scene
$ python3 - <<'PY'
> import json, subprocess, sys
> grid = json.loads(subprocess.run(["svdag", "info", "a.svdag", "--json"], capture_output=True, text=True).stdout)["grid"]
> print(grid["kind"], grid["origin"], [c == o + k * 0.3 for c, o, k in zip(grid["corner"], grid["origin"], grid["k0"])])
> PY
| origin [0.1, -7, 1000] [True, True, True]
# A part of the same world, with and without the origin's help.
$ svdag build a.ply -o part.svdag -s 0.3 --origin 0.1,-7,1e3 --bounds=-10,0,-10,10,5,10 -q
$ svdag edit a.svdag -o cut.svdag --bounds=-10,0,-10,10,5,10 -q
$ for name in part cut; do svdag export $name.svdag -o $name.npz -q; done
$ python3 - <<'PY'
> import numpy
> world = []
> for name in ("part", "cut"):
>     data = numpy.load(name + ".npz")
>     voxels = numpy.rint((data["corner"] - [0.1, -7, 1e3]) / 0.3).astype(int) + data["coordinates"]
>     world.append(set(map(tuple, voxels)))
> print(len(world[0]), "voxels, the same:", world[0] == world[1])
> PY
| 13277 voxels, the same: True
$ svdag build a.ply -o a.run -s 0.3 --origin 0.1,-7,1e3 --part 1/2 -q
$ svdag build a.ply -o b.run -s 0.3 --origin 0.1,-7,1e3 --part 2/2 -q
$ svdag merge a.run b.run -o merged.svdag -q && cmp a.svdag merged.svdag
$ svdag plan a.ply -o plan -s 0.3 --origin 0.1,-7,1e3 --shards 2 -q && svdag run plan -q && cmp a.svdag plan/plan.svdag
$ svdag build a.ply -o c.run -s 0.3 --part 2/2 -q
$ svdag merge a.run c.run -o merged.svdag
! svdag: a.run and c.run are from different bakes: --origin differs
? 2
$ svdag build a.ply -o r.svdag -r 64 --origin 0,0,0
! svdag: --origin: voxel planes follow from it with -s: give -s instead of -r
? 2
$ svdag build a.ply -o r.svdag -s 1 --origin 0,0
! svdag: --origin: "0,0" is not x,y,z
? 2
$ svdag build a.ply -o r.svdag -s 1 --origin 0,0,1e13
! svdag: --voxel-size: the scene is more than 2^38 voxels away from --origin: choose larger voxels
? 2

## build_small_lattice
# -s: the grid is no larger than it must be.
$ printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off
$ svdag build t.off -s 1 -q -o t.svdag
$ svdag info t.svdag
| t.svdag: 32^3 voxels, rule conservative
|   voxel size 1, corner (-15.5, -15.5, -15.5)
|   occupied: voxels 15 .. 25, 15 .. 25, 15 .. 25; (-0.5, -0.5, -0.5) to (10.5, 10.5, 10.5)
|   206 voxels set, 124 SVO nodes, 36 DAG nodes (44 with 2x2x2 leaves)
|   1.8 KiB, 72.4 bits per voxel; as SVO 124 bytes
|   content hash 4be5c9c2c04565a4fed1175a85d5d941
$ svdag-verify mesh t.svdag t.off | tail -1
| ok: every voxel agrees with the scene
$ svdag build t.off -s 1e-9 -o x.svdag
! svdag: --voxel-size: the scene needs more than 1M voxels on an axis: choose voxels of at least 9.6e-06, or --bounds
? 2
$ svdag build t.off -s 5cm -o x.svdag
! svdag: --voxel-size: 5cm needs --units, what one unit of the scene is; without it give the size in units of the scene
? 2
$ svdag build t.off -r 1000 -o x.svdag
! svdag: --resolution: 1000 is not a power of two: choose 512 or 1K
? 2

## build_transform
# --transform, then --up, then --scale: recorded in the file, applied by the judge.
$ printf 'OFF\n4 2 0\n0 0 0\n4 0 0\n0 2 0\n0 0 1\n3 0 1 2\n3 0 2 3\n' > z.off
$ printf 'OFF\n4 2 0\n3 0 0\n15 0 0\n3 0 -6\n3 3 0\n3 0 1 2\n3 0 2 3\n' > y.off
$ svdag build z.off -r 64 --transform=1,0,0,1,0,1,0,0,0,0,1,0,0,0,0,1 --up z --scale 3 -q -o z.svdag
$ svdag build y.off -r 64 -q -o y.svdag
$ svdag-verify diff z.svdag y.svdag -q && echo same voxels
| same voxels
$ svdag info z.svdag | sed -n 2,4p
|   voxel size 0.19047619047619047, corner (2.9047619047619047, -0.09523809523809523, -6.095238095238095)
|   scene transformed by 3,0,0,3,0,0,3,0,0,-3,0,0
|   occupied: voxels 0 .. 63, 0 .. 16, 0 .. 32; (2.9047619, -0.0952380952, -6.0952381) to (15.0952381, 3.14285714, 0.19047619)
$ svdag info z.off --up z --scale 3 | sed -n 2p
|   bounds (0, 0, -6) .. (12, 3, 0)
$ svdag-verify mesh z.svdag z.off | grep '^grid\|^missing\|^extra\|^ok'
| grid       64^3 box, voxel size 0.19047619047619047, corner (2.9047619047619047, -0.09523809523809523, -6.095238095238095), rule conservative
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag-verify check z.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag plan z.off -r 64 --transform=1,0,0,1,0,1,0,0,0,0,1,0 --up z --scale 3 --shards 2 -o plan -q && svdag run plan -q -j 1 && cmp plan/plan.svdag z.svdag
$ for up in x -x y -y z -z; do svdag build z.off -r 8 --up=$up -q -o up.svdag && svdag-verify mesh up.svdag z.off -q && echo "up $up"; done
| up x
| up -x
| up y
| up -y
| up z
| up -z
# A unit of the scene.
$ svdag build z.off -s 5cm --units m -q -o s.svdag && svdag info s.svdag | sed -n 2p
|   voxel size 0.05, corner (-6.375, -6.375, -6.375)
$ svdag build z.off -s 5cm -o x.svdag
! svdag: --voxel-size: 5cm needs --units, what one unit of the scene is; without it give the size in units of the scene
? 2
$ svdag build z.off -s 5miles -o x.svdag
! svdag: --voxel-size: "5miles" is not a size like 0.5 or 5cm
? 2
$ svdag build z.off -s 5cm --units yard -o x.svdag
! svdag: --units: unknown unit "yard": choose mm, cm, m, km, in or ft
? 2
$ svdag build z.off -r 8 --transform=1,2 -o x.svdag
! svdag: --transform: "1,2" is not 16 numbers m00,m01,...,m33, row by row, of which the last four are 0,0,0,1 or left out
? 2
$ svdag build z.off -r 8 --transform=1,0,0,0,0,1,0,0,0,0,0,0 -o x.svdag
! svdag: --transform: the matrix flattens the scene: give one with an inverse
? 2
$ svdag build z.off -r 8 --scale 0 -o x.svdag
! svdag: --scale: give a factor other than 0
? 2
$ svdag build z.off -r 8 --up w -o x.svdag
! svdag: --up: "w" is not an axis: choose x, y, z, -x, -y or -z
? 2
$ svdag info z.svdag --up z
! svdag: --up: z.svdag is a .svdag
? 2
# Runs of differently placed scenes are not of one bake.
$ for part in 1/2 2/2; do svdag build z.off -s 0.5 --bounds=0,0,0,4,4,4 --part $part --scale ${part%/2} -q -o ${part%/2}.run; done
$ svdag merge 1.run 2.run -o x.svdag
! svdag: 1.run and 2.run are from different bakes: the transform of the scene differs
? 2

## build_two_grids
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -s 0.5 -o r.svdag
! svdag: give only one of --resolution or --voxel-size; see svdag build --help
? 2
