# svdag import.

## import_formats
# An export is imported as the same DAG; content identifies the format.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 256 -o a.svdag -q
$ svdag export a.svdag --format hashdag -o a.basic_dag.dag.bin -q
$ svdag export a.svdag --format symvox -o symvox.svdag -q
$ for f in a.svo a.npz a.binvox a.vox; do svdag export a.svdag -o $f -q; done
$ for f in a.basic_dag.dag.bin symvox.svdag a.svo a.npz a.binvox a.vox; do
>   svdag import $f -o b.svdag -r 256
>   svdag-verify check b.svdag -q
>   svdag-verify diff a.svdag b.svdag --by-index -q
> done
| b.svdag: hashdag, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.7 KiB
|   content hash 8c1e65409a337afb13ff9de673ffc78c
| b.svdag: symvox, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.7 KiB
|   content hash e8c306e5a6ebb62d313b15cf58f82bbc
| b.svdag: transform-dag, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.6 KiB
|   content hash 9837d3470e955dda9be947e175bd6838
| b.svdag: npz, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.7 KiB
|   content hash 8c1e65409a337afb13ff9de673ffc78c
| b.svdag: binvox, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.7 KiB
|   content hash 8c1e65409a337afb13ff9de673ffc78c
| b.svdag: vox, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.6 KiB
|   content hash 9837d3470e955dda9be947e175bd6838
# z is up in a .vox: whichever axis becomes z, the import turns back.
$ for up in x y z; do svdag export a.svdag -o $up.vox -q --up $up && svdag import $up.vox -o b.svdag -q -r 256 --up $up && svdag-verify diff a.svdag b.svdag --by-index -q; done
$ cmp y.vox a.vox
$ svdag export a.svdag -o c.npz --up z
! svdag: --up: only vox has an axis that points up, the format is npz
? 2
$ svdag import a.npz -o c.svdag --up z
! svdag: --up: only for .vox files; a.npz is read as npz
? 2
# The points of an export are not triangles.
$ svdag export a.svdag -o points.ply -q
$ svdag import points.ply -o back.svdag
| back.svdag: ply, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.7 KiB
|   content hash 8c1e65409a337afb13ff9de673ffc78c
$ svdag build points.ply -o back.svdag -r 64
! svdag: points.ply: the scene has no triangles to bake; points.ply holds only points, which svdag import takes; for triangles, reconstruct a surface
? 3

## import_full_disk
# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
$ svdag-scene city -n 20K -q -o a.ply
$ svdag build a.ply -r 512 -o a.svdag -q
$ svdag export a.svdag --format hashdag -o a.basic_dag.dag.bin -q
$ svdag export a.svdag -o a.npz -q --level 8
$ echo old > b.svdag
$ ulimit -f 8
$ svdag import a.basic_dag.dag.bin -o b.svdag
! svdag: b.svdag: cannot be written: the file exceeds the size limit (ulimit -f)
? 4
$ svdag import a.npz -o b.svdag
! svdag: b.svdag: cannot be written: the file exceeds the size limit (ulimit -f)
? 4
$ cat b.svdag
| old
$ ls
| a.basic_dag.dag.bin
| a.npz
| a.ply
| a.svdag
| b.svdag

## import_nvdb
# NanoVDB is written but not read; --iso is rejected for a grid without values.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag export a.svdag -o a.vdb -q
$ svdag export a.svdag -o a.nvdb -q
$ svdag import a.nvdb -o b.svdag
! svdag: a.nvdb: is a NanoVDB file, which svdag cannot read: give the .vdb it was made from, or convert it with nanovdb_convert
? 3
$ svdag-verify vdb a.svdag a.nvdb
! svdag-verify: a.nvdb: is a NanoVDB file, which svdag cannot read: give the .vdb it was made from, or convert it with nanovdb_convert
? 3
$ svdag import a.vdb -o b.svdag --iso=0,1
! svdag: --iso: grid occupancy is a bool grid, which has no values to select: leave --iso out
? 2
$ svdag-verify vdb a.svdag a.vdb --iso=0,1
! svdag-verify: --iso: grid occupancy is a bool grid, which has no values to select: leave --iso out
? 2
$ svdag export a.svdag -o b.nvdb --vdb-type mask
! svdag: --vdb-type: only vdb has grids of several types, the format is nvdb
? 2
$ svdag export a.svdag -o b.npz --vdb-type bool
! svdag: --vdb-type: only vdb has grids of several types, the format is npz
? 2
$ ls
| a.nvdb
| a.ply
| a.svdag
| a.vdb

## import_points
# A voxel is set if it holds a point; its lower planes belong to it. -s: planes at multiples of it. -r: divides the box of the points.
$ printf '0 0 0 255 0 0\n0.5 0 0 0 255 0\n0.25 0.25 0.25 0 0 255\n7 7 7 9 9 9\nnan 0 0 1 1 1\n' > a.xyz
$ svdag import a.xyz -o a.svdag -s 0.5
| a.svdag: xyz, 4 points (1 more left out), 3 voxels of 16^3, colours, 5 DAG nodes, 1.6 KiB
|   content hash 1edaeef5638ac1201d9016fd637bbff2
$ svdag-verify check a.svdag -q
$ printf '0.49 0 0\n0.5 0.49 0\n1 0 0\n' | svdag query a.svdag
| set 4  0 0 0  0.5 0.5 0.5  #bc00bc
| set 4  0.5 0 0  1 0.5 0.5  #00ff00
| empty 3  1 0 0  2 1 1
$ svdag import a.xyz -o a.svdag -s 0.5 --min-points 2 --json
| {
|   "output": "a.svdag",
|   "resolution": 16,
|   "levels": 4,
|   "voxels": 1,
|   "layers": 0,
|   "dag_nodes": 3,
|   "file_bytes": 1608,
|   "content_hash": "de26a0937a0a1a825d1055aa4fd2a0dd",
|   "points": 4,
|   "points_left_out": 1
| }
$ svdag import a.xyz -o b.svdag -r 8 --no-colours
| b.svdag: xyz, 4 points (1 more left out), 3 voxels of 8^3, 3 DAG nodes, 1.4 KiB
|   content hash 63010aa06c41639959520235d4bc4a67
# Rule points is not a rule of triangles.
$ svdag-scene city -n 3K -q -o city.ply
$ svdag-verify mesh b.svdag city.ply
! svdag-verify: b.svdag: has rule points, which triangles do not decide: use svdag-verify check
? 2
$ svdag colour b.svdag city.ply -o c.svdag
! svdag: b.svdag: has rule points, not of triangles: svdag import stores the colours
? 3
$ svdag build city.ply -o c.svdag -r 64 --rule points
! svdag: --rule points: only for files of points: use svdag import
? 2
$ svdag-verify trace b.svdag city.ply
! svdag-verify: b.svdag: has rule points, which triangles do not decide: use svdag-verify check
? 2
$ svdag-verify diff a.svdag b.svdag -q
! svdag-verify: a.svdag and b.svdag have grids in different places, corner (0, 0, 0), side 8 and corner (-0.5, -0.5, -0.5), side 8: to compare them by voxel index add --by-index
? 2
# Centres of voxels, exported and imported at the same size, are the same voxels.
$ svdag build city.ply -o city.svdag -s 1 --origin 0,0,0 -q
$ svdag export city.svdag -o points.ply -q
$ svdag import points.ply -o back.svdag -s 1 -q
$ svdag-verify diff city.svdag back.svdag -q
# Several files share a grid; each can be a layer.
$ echo 3 3 3 > b.xyz
$ svdag import a.xyz b.xyz -o both.svdag -s 0.5 --layers file
| both.svdag: xyz, 5 points (1 more left out), 4 voxels of 16^3, 2 layers, 8 DAG nodes, 1.6 KiB
|   content hash 3de3a9fa18092b4647121ca72c5341c8
$ svdag info both.svdag --layers
| both.svdag: 16^3 voxels, rule points
|   voxel size 0.5, corner (0, 0, 0)
|   occupied: voxels 0 .. 14, 0 .. 14, 0 .. 14; (0, 0, 0) to (7.5, 7.5, 7.5)
|   4 voxels set, 9 SVO nodes, 8 DAG nodes (10 with 2x2x2 leaves)
|   1.6 KiB, 3.22e+03 bits per voxel; as SVO 9 bytes
|   2 layers, one for each file
|   content hash 3de3a9fa18092b4647121ca72c5341c8
|
|               voxels          nodes      own nodes  colour   layer
|                    3              5              2  #aef2bf  a.xyz
|                    1              3              1  #4f6d9e  b.xyz
# Wrong requests.
$ svdag export city.svdag -o a.npz -q
$ svdag import a.xyz -o c.svdag
! svdag: points need a voxel size or a resolution: give -s or -r
? 2
$ svdag import a.xyz -o c.svdag -s 0.5 -r 8
! svdag: points need a voxel size or a resolution: give -s or -r, not both
? 2
$ svdag import a.xyz -o c.svdag -s 5cm
! svdag: --voxel-size: "5cm" is not a size like 0.5, in units of the points
? 2
$ svdag import a.xyz -o c.svdag -s 1e-9
! svdag: -s: the points need more than 1M voxels on an axis: choose larger voxels
? 2
$ svdag import a.xyz -o c.svdag -s 1e-20
! svdag: -s: the points are more than 2^38 voxels away from zero: choose larger voxels
? 2
$ svdag import a.xyz -o c.svdag -s 0.5 --layers class
! svdag: --layers class: only for .las files; a.xyz is read as xyz
? 2
$ svdag import a.xyz -o c.svdag -s 0.5 --layers object
! svdag: --layers: unknown kind "object": choose class or file
? 2
$ svdag import a.xyz a.npz -o c.svdag -s 0.5
! svdag: --voxel-size: only for .las, .ply, .pcd and .xyz files; a.npz is read as npz
? 2
$ svdag import a.xyz a.xyz c.svdag -o c.svdag -s 0.5
! svdag: c.svdag is also an input, which is never overwritten: choose another output
? 2
$ svdag import a.xyz -o c.svdag -s 0.5 --min-points 0
! svdag: --min-points: "0" is not a number from 1 to 1000000000; see svdag import --help
? 2
$ svdag import city.ply -o c.svdag -s 1
! svdag: city.ply: is a mesh: bake it with svdag build
? 3
$ echo 1000000000 0 0 > one.xyz
$ svdag import one.xyz -o c.svdag -r 64
! svdag: -r: all points are at one place: give -s instead
? 2
$ echo 1000000000.000001 0 0 >> one.xyz
$ svdag import one.xyz -o c.svdag -r 64K
! svdag: -r: voxels of 1.455213727635996e-11 are below the precision of the coordinates: choose a lower resolution
? 2
$ printf 'ASTM-E57 and more' > a.e57
$ svdag import a.e57 -o c.svdag -s 1
! svdag: a.e57: is an E57 file, which svdag cannot read: convert it to .las, for example with pdal translate
? 3
$ printf 'LASF' > a.las
$ svdag import a.las -o c.svdag -s 1
! svdag: a.las: ends within its header (at byte 4)
? 3
$ svdag import a.npz -o c.svdag -s 1
! svdag: --voxel-size: only for .las, .ply, .pcd and .xyz files; a.npz is read as npz
? 2
$ ls *.svdag
| a.svdag
| b.svdag
| back.svdag
| both.svdag
| city.svdag

## import_vdb
# OpenVDB decodes in a separate process; --sandbox gives the same result.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag export a.svdag -o a.vdb -q
$ head -c 9000 a.vdb > cut.vdb
$ for sandbox in "" --sandbox; do
>   svdag import a.vdb -o b.svdag $sandbox
>   svdag-verify diff a.svdag b.svdag -q
>   svdag-verify vdb a.svdag a.vdb -q $sandbox
>   svdag import cut.vdb -o c.svdag $sandbox || echo "exit $?"
>   svdag-verify vdb a.svdag cut.vdb $sandbox || echo "exit $?"
> done
| b.svdag: vdb, 17,099 voxels of 64^3, 234 DAG nodes, 5.1 KiB
|   content hash 446add051fc2ff019b1ae305fcbfff45
| exit 3
| exit 3
| b.svdag: vdb, 17,099 voxels of 64^3, 234 DAG nodes, 5.1 KiB
|   content hash 446add051fc2ff019b1ae305fcbfff45
| exit 3
| exit 3
! svdag: cut.vdb: OpenVDB cannot read it: it is truncated, or its counts and offsets are wrong
! svdag-verify: cut.vdb: OpenVDB cannot read it: it is truncated, or its counts and offsets are wrong
! svdag: cut.vdb: OpenVDB cannot read it: it is truncated, or its counts and offsets are wrong
! svdag-verify: cut.vdb: OpenVDB cannot read it: it is truncated, or its counts and offsets are wrong
$ ls
| a.ply
| a.svdag
| a.vdb
| b.svdag
| cut.vdb

## import_wrong_requests
# Wrong requests: one message each.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag export a.svdag -o a.vox -q
$ svdag import a.svdag -o b.svdag
! svdag: a.svdag: is already a .svdag of this program
? 2
$ svdag import a.ply -o b.svdag
! svdag: a.ply: is a mesh: bake it with svdag build
? 3
$ svdag import a.vox -o a.vox
! svdag: a.vox is also an input, which is never overwritten: choose another output
? 2
$ svdag import a.vox -o b.svdag -r 32
! svdag: -r: the voxels need a resolution of at least 64
? 2
$ svdag import a.vox -o b.svdag --format foo
! svdag: --format: unknown format "foo": choose one of transform-dag, npz, binvox, vox, vdb, las, ply, pcd, xyz, hashdag, symvox
? 2
$ svdag import a.vox -o b.svdag --format npz
! svdag: a.vox: is not a zip file (it has no directory)
? 3
$ svdag import a.vox -o b.svdag --grid occupancy
! svdag: --grid: only for .vdb files; a.vox is read as vox
? 2
$ svdag import a.vox -o b.svdag --iso=0,1
! svdag: --iso: only for .vdb files; a.vox is read as vox
? 2
$ svdag import a.vox -o b.run
! svdag: b.run: the output must end in .svdag: use svdag export for other formats
? 2
$ svdag import a.vox
! svdag: --output is required; see svdag import --help
? 2
$ svdag import none.vox -o b.svdag
! svdag: none.vox: cannot be opened: no such file or folder
? 3
$ ls
| a.ply
| a.svdag
| a.vox
