# svdag-scene.

## scene_bad_count
$ svdag-scene city -n many -o t.ply
! svdag-scene: --triangles: "many" is not a number like 5000, 260K or 10M
? 2

## scene_bad_yaw
$ svdag-scene hairball -n 2K --yaw nan -o t.ply
! svdag-scene: --yaw: give -360 to 360 degrees
? 2

## scene_counts
# "10K" counts in thousands; the count that was made is printed.
$ svdag-scene city -n 10K -o city.ply
| city.ply: 9,996 triangles, 6,664 vertices
$ svdag-scene scan --triangles 1.2M -o scan.ply
| scan.ply: 1,198,272 triangles, 602,934 vertices

## scene_full_disk
# A limit on the file size simulates a full disk; the old file is kept.
$ echo old > city.ply
$ ulimit -f 8
$ svdag-scene city -n 100K -o city.ply
! svdag-scene: city.ply: cannot be written: the file exceeds the size limit (ulimit -f)
? 4
$ cat city.ply
| old
$ ls
| city.ply

## scene_help
$ svdag-scene --help
|...
| Example:
|...

## scene_missing_folder
$ svdag-scene city -n 120 -o missing/city.ply
! svdag-scene: missing: cannot write in this folder: no such file or folder
? 4

## scene_names
# One pattern per option, so that scene files may follow; the option may be repeated.
$ svdag-scene city -n 3K -q -o hall.ply
$ svdag-scene rectangle -q -o sky1.ply
$ svdag-scene rectangle -q -o props.ply
$ svdag build hall.ply sky1.ply --exclude 'sky*' props.ply -r 64 -o a.svdag -q
$ svdag build hall.ply props.ply -r 64 -o b.svdag -q
$ cmp a.svdag b.svdag
$ svdag build --include 'hall*' --include props.ply hall.ply sky1.ply props.ply -r 64 -o c.svdag -q
$ cmp b.svdag c.svdag
$ svdag info --exclude 'sky*' sky1.ply hall.ply | head -n 1
| sky1.ply and 1 more: 3,000 triangles, 2,000 positions, 250 components
$ svdag plan --exclude 'sky*' hall.ply --exclude 'props*' props.ply sky1.ply -r 64 --shards 1 -o p -q
$ svdag build hall.ply -r 64 -o hall.svdag -q
$ svdag run p -q -j 1
$ cmp p/p.svdag hall.svdag

## scene_no_output
$ svdag-scene city
! svdag-scene: --output is required; see svdag-scene --help
? 2

## scene_rectangle
# The generator gives the same file on every machine.
$ svdag-scene rectangle -o r.ply
| r.ply: 2 triangles, 4 vertices
$ sha256sum r.ply
| 2ce200cc92d00f51c8d3e8540969376648051fcb422ac11298910aeeeb75cee0  r.ply

## scene_same_bytes
# One known hash per kind: compilers and flags do not affect the bytes.
$ svdag-scene atrium -n 100K -q -o atrium.ply
$ svdag-scene hairball -n 10K -q -o hairball.ply
$ svdag-scene scan -n 10K -q -o scan.ply
$ svdag-scene city -n 10K -q --yaw 30 -o city.ply
$ svdag-scene terrain -n 10K -q --double -o terrain.ply
$ svdag-scene terrain -n 10K -q --shuffle --seed 7 -o shuffled.ply
$ svdag-scene sheet -q -o sheet.ply
$ sha256sum *.ply
| cd7cf1fd522fc6e06a394f370f46e4dc81391fcb9fda530edff381ea442d86d6  atrium.ply
| 87e9655882d4f54dec27ae9130c7121b32ca10d9b756ebb85398ce10448c12c4  city.ply
| 9ec5cb793c160742b74dbc9a4c86cd7d8a25c03faf1959d17a4501e4e5ce3e11  hairball.ply
| daf97fcac9a312252048c13b27342502adcfe59135af4c35d9790999693f98e8  scan.ply
| 87a14e24c16d86c1f55c41eed00545c4e6d286ac886f0710af9b304ea8db9fa8  sheet.ply
| b6cf8c7b6eb9f328264c1e4b6c283c7c0733de3c52459cbacc4ce8ae7d3bb232  shuffled.ply
| f2639512fb5d3b1dad21e0002a7c03fb9ddb4b9d14f04d56090e37550fa2a8d0  terrain.ply

## scene_textured
# As a GLB the atrium has textures of every kind; all of it is baked, and coloured.
$ svdag-scene atrium -n 90K -o atrium.glb
| atrium.glb: 88,972 triangles, 72,418 vertices
$ sha256sum atrium.glb
| c46674db764edac2e71070490564168ef93f100098fbc213c68f474cdfcbe703  atrium.glb
$ svdag info atrium.glb | tail -1
|   5,184 triangles are cut out by the alpha of their material
$ svdag info atrium.glb --parts | grep material:
|              716  material:terracotta  (-15.6000061, -0.5, -8.1000061) .. (15.6000061, 0, 8.1000061)
|            3,840  material:mosaic  (-11.9900055, 0, -4.49000549) .. (11.9900055, 0.0149993896, 4.49000549)
|           37,512  material:limestone  (-16.1000061, 0, -8.6000061) .. (16.1000061, 9.30000305, 8.6000061)
|            9,504  material:marble  (-12.3847961, 0.13999939, -4.88479614) .. (12.3847961, 6.67999268, 4.88479614)
|            9,504  material:painted  (-12.3692017, 0.0149993896, -4.86920166) .. (12.3692017, 7.13999939, 4.86920166)
|            6,200  material:brick  (-16.1000061, -0.5, -8.6000061) .. (16.1000061, 9.19999695, 8.6000061)
|            5,184  material:leaves  (-11.7674103, 0.675003052, -4.40486145) .. (11.9405518, 1.32740784, 4.37942505), 57.1 % opaque
|            8,000  material:red cloth  (-12.6257477, 0.840011597, -5.16810608) .. (12.6290283, 8.80000305, 5.1103363)
|            6,400  material:blue cloth  (-11.6937561, 0.840118408, -5.14982605) .. (11.6937561, 8.80000305, 5.13121033)
|            2,112  material:roof  (-16.1000061, 9.30000305, -8.6000061) .. (16.1000061, 10.769989, 8.6000061)
$ svdag build atrium.glb -r 256 --colours -o a.svdag | sed 's/, [0-9.]* s$//'
| a.svdag: 256^3, 88,972 triangles, 379,044 voxels, 5,433 nodes, 273.5 KiB (5.91 bits per voxel)
|   400,267 colours down to level 8, 194.0 KiB (3.97 bits each), a cube spans 26 texels
|   5,184 triangles are cut out by the alpha of their material
|   colour hash da27cac0478b1cbd6942d0849e920083
$ svdag-verify mesh a.svdag atrium.glb | tail -1
| ok: every voxel agrees with the scene
$ svdag-scene scan -n 2K -q -o scan.glb
! svdag-scene: scan.glb: this scene has no textures or movement: write a .ply or an .obj
? 2
$ svdag-scene atrium --shuffle -q -o a.glb
! svdag-scene: --shuffle: a .glb keeps the order of its parts: write a .ply
? 2

## scene_walks
# The figure has a skeleton and an animation, which are followed.
$ svdag-scene figure -q -o figure.glb
$ sha256sum figure.glb
| c74342c7a30f1363019c9ef5ee416f052c7c30156d18a86f5117d8ebb4c05490  figure.glb
$ svdag info figure.glb | tail -1
|   animation #0 walk: 1 s, moves 12 nodes, morphs 0
$ svdag build figure.glb -r 128 --frames 0:0.75:0.25 -o a.svdag | sed 's/, [0-9.]* s$//'
| a.svdag: 128^3, 79,200 triangles, 16,306 voxels, 3,178 nodes, 37.9 KiB (19.1 bits per voxel)
$ svdag-verify mesh a.svdag figure.glb --frames 0:0.75:0.25 | grep -v grid
| judge      integer: exact clipping
| triangles  79,200
| layers     4 layers agree
| ok: every voxel agrees with the scene
$ svdag-scene figure --yaw 30 -q -o figure.glb
! svdag-scene: --yaw: the joints of a .glb do not turn: write a .ply
? 2

## scene_too_few
$ svdag-scene atrium -n 100 -o t.ply
! svdag-scene: --triangles: this scene needs at least 84108 triangles
? 2

## scene_unknown_kind
$ svdag-scene teapot -o t.ply
! svdag-scene: "teapot" is not a kind of scene: choose one of atrium, hairball, scan, city, terrain, rectangle, sheet, speck, figure
? 2
