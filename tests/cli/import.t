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
# The points of an export are neither voxels with a grid nor triangles.
$ svdag export a.svdag -o points.ply -q
$ svdag import points.ply -o back.svdag
| back.svdag: ply, 328,308 voxels of 256^3, 1,272 DAG nodes, 27.7 KiB
|   content hash 8c1e65409a337afb13ff9de673ffc78c
$ svdag build points.ply -o back.svdag -r 64
! svdag: points.ply: the scene has no triangles to bake; points.ply holds only points: reconstruct a surface first, for example with CloudCompare
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
! svdag: --format: unknown format "foo": choose one of transform-dag, npz, binvox, vox, ply, vdb, hashdag, symvox
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
