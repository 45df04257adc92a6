# svdag build --part, and selected parts of a scene.

## build_bad_part
$ svdag-scene rectangle -q -o r.ply
$ for part in 0/2 3/2 1-2 1/2x; do svdag build r.ply -r 64 --part $part -o r.run || true; done
! svdag: --part 0/2: parts are numbered from 1 to the count, which is at most 1000000
! svdag: --part 3/2: parts are numbered from 1 to the count, which is at most 1000000
! svdag: --part: "1-2" is not I/N, for example 3/8
! svdag: --part: "1/2x" is not I/N, for example 3/8
$ svdag build r.ply -r 16 --part 1/64 -o r.run
! svdag: a grid of 16^3 voxels is too small for this many parts: use fewer
? 2

## build_part_of_a_dag
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 --part 1/2 -o r.svdag
! svdag: r.svdag: a part of a grid is a run: choose an output that ends in .run
? 2

## parts
# --include and --exclude match objects, materials and files; a kind before a colon chooses one.
$ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\no wall\nusemtl brick red\nf 1 2 3\nusemtl glass\nf 1 2 4\no brick oven\nf 2 3 4\n' > house.obj
$ svdag info house.obj --parts | sed -n '/object/,$p'
|                2  object:wall  (0, 0, 0) .. (9, 9, 9)
|                1  object:brick oven  (0, 0, 0) .. (9, 9, 9)
|                1  material:brick red  (0, 0, 0) .. (1, 1, 0)
|                2  material:glass  (0, 0, 0) .. (9, 9, 9)
|                3  file:house.obj  (0, 0, 0) .. (9, 9, 9)
$ count() { svdag info house.obj "$@" | head -1; }
$ count --include 'brick*'
| house.obj: 2 triangles, 4 positions, 1 component
$ count --include 'material:brick*'
| house.obj: 1 triangle, 3 positions, 1 component
$ count --include 'object:brick*'
| house.obj: 1 triangle, 3 positions, 1 component
$ count --exclude glass
| house.obj: 1 triangle, 3 positions, 1 component
$ count --include wall --exclude 'material:glass'
| house.obj: 1 triangle, 3 positions, 1 component
$ count --include 'file:house*'
| house.obj: 3 triangles, 4 positions, 1 component
# A pattern that matches nothing is a mistake.
$ svdag build house.obj -r 8 --include 'windwo*' --include glass -o x.svdag
! svdag: --include 'windwo*' matches nothing: the nearest names are object:wall, material:glass, file:house.obj (--allow-empty goes on)
? 2
$ svdag build house.obj -r 8 --exclude 'material:brik*' -o x.svdag
! svdag: --exclude 'material:brik*' matches nothing: the nearest names are material:brick red, material:glass, object:wall (--allow-empty goes on)
? 2
$ svdag build house.obj -r 8 --exclude 'object:glass' -o x.svdag
! svdag: --exclude 'object:glass' matches nothing: the nearest names are material:glass, object:wall, file:house.obj (--allow-empty goes on)
? 2
$ svdag build house.obj -r 8 --exclude 'windwo*' --allow-empty -q -o x.svdag && svdag-verify mesh x.svdag house.obj --exclude 'windwo*' --allow-empty -q && echo baked
| baked
$ svdag info house.obj --parts --json | grep -c kind
| 5

## parts_of_a_scene
# The names that --include matches; a pattern that matches nothing is an error, or reported with --allow-empty.
$ printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\ng wall\nf 1 2 3\nf 1 2 4\ng roof\nf 2 3 4\n' >house.obj
$ svdag info house.obj --parts | tail -n 4
|        triangles  part
|                2  object:wall  (0, 0, 0) .. (1, 1, 1)
|                1  object:roof  (0, 0, 0) .. (1, 1, 1)
|                3  file:house.obj  (0, 0, 0) .. (1, 1, 1)
$ svdag info house.obj --json --parts | tail -n 11
|         0.0,
|         0.0,
|         0.0,
|         1.0,
|         1.0,
|         1.0
|       ],
|       "opaque": 1.0
|     }
|   ]
| }
$ svdag build house.obj -r 64 -o house.svdag --include wall --include windw --exclude 'sky*' --allow-empty | tail -n +2
|   no part of the scene matches --include 'windw'
|   no part of the scene matches --exclude 'sky*'
$ svdag build house.obj -r 64 -o house.svdag --include windw --allow-empty
! svdag: house.obj: the scene has no triangles to bake; nothing matches --include 'windw'
? 3
$ svdag plan house.obj -r 64 --shards 2 -o house.plan --exclude 'sky*' --allow-empty | tail -n 1
|   no part of the scene matches --exclude 'sky*'
$ svdag info house.obj --levels
! svdag: --levels: house.obj is a scene
? 2
$ svdag info house.plan --parts
! svdag: --parts: house.plan is a plan
? 2
