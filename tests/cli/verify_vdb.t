# svdag-verify vdb.

## verify_vdb_bounds
# The part's grid ends at 51.2. Within --bounds all voxels of the other grid count, also those beyond the file's grid.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -s 0.05 -o whole.svdag -q
$ svdag build a.ply -s 0.05 --bounds=10,2,10,20,9,20 -o part.svdag -q
$ svdag export whole.svdag -o whole.vdb -q
$ svdag export part.svdag -o part.vdb -q
$ svdag-verify vdb part.svdag whole.vdb --bounds=10,2,10,20,9,20
| grid     occupancy, bool, on level 9 (512^3)
| both     69,936 voxels
| missing  0
| extra    0
| same
$ svdag-verify vdb part.svdag whole.vdb --bounds=10,2,10,60,9,20 --show 0
| grid     occupancy, bool, on level 9 (512^3)
| both     69,936 voxels
| missing  155,419
| extra    0
| different
? 1
$ svdag-verify vdb part.svdag part.vdb --bounds=10,2,10,60,9,20 -q
$ svdag-verify vdb part.svdag whole.vdb --bounds=55,2,55,60,9,60
! svdag-verify: --bounds: the box contains no voxel of the grid
? 2

## verify_vdb_far_from_zero
# An export is compared voxel by voxel at any position and size.
$ judge() {
>   svdag build scene.obj -r "$1" -o a.svdag -q
>   svdag export a.svdag -o a.vdb -q
>   svdag-verify vdb a.svdag a.vdb || echo "exit $?"
>   svdag export a.svdag -o coarse.vdb -q --level 5
>   svdag-verify vdb a.svdag coarse.vdb -q || echo "exit $?"
> }
$ printf 'v 1000000000000 0 5\nv 1000000000001.3 1 5\nv 1000000000000 1 6\nf 1 2 3\n' > scene.obj
$ judge 1K
| grid     occupancy, bool, on level 10 (1K^3)
| both     1,117,760 voxels
| missing  0
| extra    0
| same
$ judge 4K
| grid     occupancy, bool, on level 12 (4K^3)
| both     17,871,738 voxels
| missing  0
| extra    0
| same
$ for power in -290 290; do
>   printf "v 0 0 0\nv 1e$power 1e$power 0\nv 0 1e$power 1e$power\nf 1 2 3\n" > scene.obj
>   judge 64
> done
| grid     occupancy, bool, on level 6 (64^3)
| both     6,238 voxels
| missing  0
| extra    0
| same
| grid     occupancy, bool, on level 6 (64^3)
| both     6,238 voxels
| missing  0
| extra    0
| same
# A shift by a quarter of a voxel is detected there, too.
$ printf 'v 1000000000000 0 5\nv 1000000000001 1 5\nv 1000000000000 1 6\nf 1 2 3\n' > scene.obj
$ svdag build scene.obj -r 64 -o here.svdag -q
$ printf 'v 1000000000000.25 0 5\nv 1000000000001.25 1 5\nv 1000000000000.25 1 6\nf 1 2 3\n' > scene.obj
$ svdag build scene.obj -r 64 -o there.svdag -q
$ svdag export there.svdag -o there.vdb -q
$ svdag-verify vdb here.svdag there.vdb
! svdag-verify: there.vdb: grid occupancy cannot be compared: its voxel centres are (-0.25, 0, 0) voxels away from those of the file
? 2

## verify_vdb_other_grid
# Grids that do not match the file's voxels are rejected, with the difference.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag build a.ply -s 1 -o b.svdag -q
$ svdag export b.svdag -o b.vdb -q
$ svdag-verify vdb a.svdag b.vdb
! svdag-verify: b.vdb: grid occupancy cannot be compared: its voxels are 1 wide, those of the file 1.5238095238095237, and no level of it has such voxels
? 2
$ svdag-verify vdb a.svdag a.ply
! svdag-verify: a.ply: OpenVDB cannot read it: IoError: not a VDB file
? 3
$ svdag-verify vdb a.svdag none.vdb
! svdag-verify: none.vdb: cannot be opened: no such file or folder
? 3
$ svdag-verify vdb a.svdag b.vdb --grid other
! svdag-verify: b.vdb: has no grid other: choose one with --grid: occupancy
? 2
$ svdag-verify vdb a.svdag b.vdb --iso=2,1
! svdag-verify: --iso: "2,1" is not LOW,HIGH with the lower value first
? 2

## verify_vdb_write_diff
# Voxels in only one of the two files are written as two grids; with the thin file they form the whole.
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag build a.ply -r 128 -o whole.svdag -q
$ svdag build a.ply -r 128 --rule thin -o thin.svdag -q
$ svdag export whole.svdag -o whole.vdb -q
$ svdag export thin.svdag -o thin.vdb -q
$ svdag-verify vdb thin.svdag whole.vdb --show 2 --write-diff d.vdb
| grid       occupancy, bool, on level 7 (128^3)
| both       33,448 voxels
| missing    24,601
| extra      0
|   missing  voxel (6, 31, 39) at (-37.1627202, -21.9165725, -12.090915)
|   missing  voxel (7, 30, 39) at (-36.3159694, -22.7633233, -12.090915)
| different
? 1
$ svdag-verify vdb whole.svdag d.vdb --grid missing --show 0
| grid     missing, bool, on level 7 (128^3)
| both     24,601 voxels
| missing  0
| extra    33,448
| different
? 1
$ svdag-verify vdb whole.svdag thin.vdb --json --show 1
| {"command":"vdb","file":"whole.svdag","content_hash":"07a2c65e7cf1d8a33f30cc17e872a5f0","vdb":"thin.vdb","grid":"occupancy","type":"bool","level":7,"both":33448,"missing":0,"extra":24601,"first_missing":[],"first_extra":[[25,21,31]],"same":false}
? 1
$ svdag-verify vdb whole.svdag thin.vdb -q --write-diff d.vdb --write-most 10
! svdag-verify: d.vdb: would get 24601 voxels, --write-most is 10: raise --write-most
? 2
