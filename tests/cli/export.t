# svdag export.

## export_binvox_tight
# A binvox file is the smallest cube of what is occupied, or of --bounds; an import has it in the same place.
$ printf 'v 0 0 0\nv 11 0 0\nv 11 7 0\nv 0 7 3\nf 1 2 3 4\n' > a.obj
$ svdag build a.obj -o a.svdag -s 1 --origin 0,0,0 -q
$ svdag info a.svdag | grep 'voxels,\|occupied'
| a.svdag: 32^3 voxels, rule conservative
|   occupied: voxels 15 .. 27, 15 .. 23, 15 .. 19; (-1, -1, -1) to (12, 8, 4)
$ svdag export a.svdag -o a.binvox && head -4 a.binvox | tail -3
| a.binvox: binvox, 213 voxels of level 5 (32^3)
| dim 13 13 13
| translate -1 -1 -1
| scale 13
$ svdag export a.svdag -o all.binvox --bounds=-99,-99,-99,99,99,99 -q && head -2 all.binvox | tail -1
| dim 32 32 32
$ svdag export a.svdag -o half.binvox --level 3 -q && head -4 half.binvox | tail -3
| dim 4 4 4
| translate -4 -4 -4
| scale 16
$ svdag import a.binvox -o back.svdag
| back.svdag: binvox, 213 voxels of 16^3, 17 DAG nodes, 1.6 KiB
|   content hash 0e168f5a2f473bc66ae1efce0615a22f
$ svdag info back.svdag | grep occupied
|   occupied: voxels 0 .. 12, 0 .. 8, 0 .. 4; (-1, -1, -1) to (12, 8, 4)
$ echo '0.5 0.5 0.1' | svdag query a.svdag | cut -d' ' -f1
| set
$ echo '0.5 0.5 0.1' | svdag query back.svdag | cut -d' ' -f1
| set

## export_dag_full_disk
# A limit on the file size simulates a full disk: the old file is kept, no other file remains.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 256 -o a.svdag -q
$ for f in a.svo a.npz a.octree a.basic_dag.dag.bin; do echo old > $f; done
$ ulimit -f 8
$ for f in a.svo a.npz a.octree a.basic_dag.dag.bin; do
>   svdag export a.svdag -o $f || echo "exit $?"
> done
| exit 4
| exit 4
| exit 4
| exit 4
! svdag: a.svo: cannot be written: the file exceeds the size limit (ulimit -f)
! svdag: a.npz: cannot be written: the file exceeds the size limit (ulimit -f)
! svdag: a.octreenodes: cannot be written: the file exceeds the size limit (ulimit -f)
! svdag: a.basic_dag.dag.bin: cannot be written: the file exceeds the size limit (ulimit -f)
$ cat a.svo a.npz a.octree a.basic_dag.dag.bin
| old
| old
| old
| old
$ ls
| a.basic_dag.dag.bin
| a.npz
| a.octree
| a.ply
| a.svdag
| a.svo

## export_formats
# Known hashes of every format that needs no library. An .octree is three files.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ svdag export r.svdag -o r64.basic_dag.dag.bin
| r64.basic_dag.dag.bin: hashdag, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag --format symvox -o r.symvox
| r.symvox: symvox, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r.svo
| r.svo: transform-dag, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r.octree
| r.octree: octree, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r.npz
| r.npz: npz, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r.binvox
| r.binvox: binvox, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r.vox
| r.vox: vox, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r.ply2 --format ply
| r.ply2: ply, 4,984 voxels of level 6 (64^3)
$ svdag export r.svdag -o r16.svo --level 4
| r16.svo: transform-dag, 336 voxels of level 4 (16^3)
$ rm r.ply r.svdag
$ sha256sum *
| b00132a9a52b95f8afb6e64179f15fb2f9f7f7d69489e8933069b01a482ed0d8  r.binvox
| 0b6567fb0fe80b2421a93b4656cb5f23a06822ca8a64de3f857ba0555b8231c7  r.npz
| 631949b1787d2d719f34bb5c1fc6c6b56b68b10bdfd0dcd850bcfa34cdd7d851  r.octree
| 9f629109abb4e790e598c4283988572b01f16a506db99ff49bdeb53d1f2f2dc7  r.octreedata
| a57981d398613b2964732e9385d70330cc72aff92428e4f841900d9326b4c4c2  r.octreenodes
| 4e1292e5a9242d47af55730a69f44107ec7a00b94df0a1e2d5486fa4a1e00433  r.ply2
| 01f61588b16629acb19da1feda9f2f5bba0dbcb5a36dfdfa44aeea082d043d03  r.svo
| df6ee19e690a7bd55dd1f850ecb44e8518afb7e6f1cd242ee758a33367fa1eaf  r.symvox
| 533c7476e4e496eb9d5352802747bc5b6b811e9b0b20c69a0d1ca9566708d99a  r.vox
| 33dda1980206bbbe13a558781ff8ba1bebfb15ce43bfac4f4eada023cec17e4b  r16.svo
| ec428c4b8679b018836bf0239cc40d50557b896a3b9e3063a2f7602b2d33aca7  r64.basic_dag.dag.bin

## export_full_disk
# OpenVDB does not report a full disk; svdag does. The old file is kept, no other file remains.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 256 -o a.svdag -q
$ echo old > a.vdb
$ ulimit -f 8
$ svdag export a.svdag -o a.nvdb
! svdag: a.nvdb: could not be written completely: is the disk full?
? 4
$ svdag export a.svdag -o a.vdb
! svdag: a.vdb: could not be written completely: is the disk full?
? 4
$ cat a.vdb
| old
$ ls
| a.ply
| a.svdag
| a.vdb

## export_hashdag_name
# HashDAG prescribes the file name: DIR/NAME is extended to it.
$ svdag-scene speck -q -o s.ply
$ svdag build s.ply -r 128K -o s.svdag -q
$ mkdir data
$ svdag export s.svdag --format hashdag -o data/speck
| data/speck128k.basic_dag.dag.bin: hashdag, 4 voxels of level 17 (128K^3)
$ svdag export s.svdag --format hashdag -o data/speck --level 10 -q
$ ls data
| speck128k.basic_dag.dag.bin
| speck1k.basic_dag.dag.bin
$ svdag export s.svdag --format hashdag -o data/speck --level 9
! svdag: data/speck: HashDAG defines no name for grids below 1K^3: give the full name, ending in .basic_dag.dag.bin
? 2

## export_little_memory
# An export that does not fit in memory is rejected before it begins.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 512 -o a.svdag -q
$ svdag export a.svdag -o a.vdb -m 1M
! svdag: the grid would have more than 2,184 leaves, too many for --memory: export a coarser --level, or a part with --bounds
? 5
$ svdag export a.svdag -o a.vdb -m 8M
! svdag: the leaves of the grid need 10 MiB in total, but the memory budget is 8 MiB: raise --memory
? 5
$ svdag export a.svdag -o a.vdb -m 1M --level 4 -q
$ ls
| a.ply
| a.svdag
| a.vdb

## export_program_missing
# `svdag export` is a separate program in the folder of svdag.
$ cp "$(command -v svdag)" svdag
$ ./svdag export a.svdag -o a.vdb
!* svdag: svdag export: cannot start the program */svdag-export: install it beside svdag
? 2

## export_refused
# Exports that a format cannot hold are rejected before anything is written, with exit code 2 and a remedy.
$ svdag-scene speck -q -o s.ply
$ svdag build s.ply -r 256K -o s.svdag -q
$ svdag export s.svdag --format hashdag -o s
! svdag: HashDAG holds grids up to 128K^3, this one has 256K^3: export a coarser --level
? 2
$ svdag export s.svdag -o s.binvox
! svdag: binvox stores every voxel, set or not: a window has at most 4,096 voxels per axis, this one has 262,144: export a coarser --level, or a part with --bounds
? 2
$ svdag export s.svdag -o s.vox -q
$ svdag export s.svdag -o s.npz --level 7 --max-voxels 2
! svdag: there are 3 voxels to write, more than 2: export a coarser --level, a part with --bounds, or raise --max-voxels
? 2
$ svdag export s.svdag -o s.svo --bounds=900,0,0,901,1,1
! svdag: --bounds: the box meets no voxel of the grid that may be set
? 2
$ svdag export s.svdag --format octree -o s.oct
! svdag: s.oct: the name must end in .octree (two more files are written beside it)
? 2
$ svdag export s.svdag -o s.npz --bounds=900,0,0,901,1,1
! svdag: --bounds: the box meets no voxel of the grid that may be set
? 2
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 32K -o r.svdag -q
$ svdag export r.svdag -o r.vox --level 14
! svdag: vox holds models of 256^3 voxels, this window needs more than 4,096: export a coarser --level, or a part with --bounds
? 2
$ svdag export r.svdag -o r.vox
! svdag: there are 1,299,101,520 voxels to write, more than 1,000,000,000: export a coarser --level, a part with --bounds, or raise --max-voxels
? 2
$ for size in 1e40 1e-300; do
>   printf 'v 0 0 0\nv %s 0 0\nv 0 %s %s\nf 1 2 3\n' $size $size $size > t.obj
>   svdag build t.obj -r 8 -o t.svdag -q
>   svdag export t.svdag --format symvox -o t.out || echo "exit $?"
> done
| exit 2
| exit 2
! svdag: SymVox stores the box of a grid as float32, and this box is too large, too small or too far from zero: export hashdag, which stores float64
! svdag: SymVox stores the box of a grid as float32, and this box is too large, too small or too far from zero: export hashdag, which stores float64
$ svdag build s.ply -r 8 --bounds=1e9,0,0,1000000001,1,1 -o t.svdag -q
$ svdag export t.svdag --format symvox -o t.out
! svdag: SymVox stores the box of a grid as float32, and this box is too large, too small or too far from zero: export hashdag, which stores float64
? 2
$ rm t.obj t.svdag
$ ls
| r.ply
| r.svdag
| s.ply
| s.svdag
| s.vox

## export_vdb
# OpenVDB exports of whole files, levels and windows equal the file.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 256 -o a.svdag -q
$ svdag export a.svdag -o a.vdb
| a.vdb: vdb, 328,308 voxels of level 8 (256^3)
$ svdag-verify vdb a.svdag a.vdb
| grid     occupancy, bool, on level 8 (256^3)
| both     328,308 voxels
| missing  0
| extra    0
| same
$ svdag export a.svdag -o level.vdb --level 6 --vdb-type mask
| level.vdb: vdb, 14,750 voxels of level 6 (64^3)
$ svdag-verify vdb a.svdag level.vdb
| grid     occupancy, mask, on level 6 (64^3)
| both     14,750 voxels
| missing  0
| extra    0
| same
$ svdag export a.svdag --format vdb -o window --bounds=10,0,10,40,20,30
| window: vdb, 17,396 voxels of level 8 (256^3)
$ svdag-verify vdb a.svdag window --bounds=10,0,10,40,20,30
| grid     occupancy, bool, on level 8 (256^3)
| both     17,396 voxels
| missing  0
| extra    0
| same
$ svdag-verify vdb a.svdag window --show 2
| grid     occupancy, bool, on level 8 (256^3)
| both     17,396 voxels
| missing  0
| extra    310,912
|   extra  voxel (0, 0, 0) at (-48, -1, -48)
|   extra  voxel (0, 0, 1) at (-48, -1, -47.6235294)
| different
? 1
$ svdag export a.svdag -o fog.vdb --vdb-type float -q
$ svdag-verify vdb a.svdag fog.vdb --iso=0.5,1 | tail -1
| same
$ svdag export a.svdag -o a.nvdb --level 7 -q
$ head -c 7 a.nvdb && echo
| NanoVDB
$ ls
| a.nvdb
| a.ply
| a.svdag
| a.vdb
| fog.vdb
| level.vdb
| window

## export_vdb_exact
# Voxels of any size and position are imported from a .vdb with exactly the same grid.
$ grid_of() { svdag info --json "$1" | sed -n '/"corner"/,/]/p; /"voxel_size"/p'; }
$ printf 'v 0.1 0.2 0.3\nv 0.10001 0.20003 0.3\nv 0.10002 0.2 0.30004\nf 1 2 3\n' > tiny.obj
$ printf 'v 1841111.4 5176075.3 191.1\nv 1841111.41 5176075.31 191.1\nv 1841111.4 5176075.31 191.12\nf 1 2 3\n' > far.obj
$ svdag build tiny.obj -s 1e-6 -o tiny.svdag -q
$ svdag build tiny.obj -r 64 -o box.svdag -q
$ svdag build far.obj -s 0.0003 -o far.svdag -q
$ svdag build far.obj -r 64 -o farbox.svdag -q
$ for name in tiny box far farbox; do
>   for type in bool mask; do
>     svdag export $name.svdag -o $name.vdb -q --vdb-type $type
>     svdag import $name.vdb -o back.svdag -q
>     grid_of $name.svdag > before
>     grid_of back.svdag > after
>     cmp before after
>     svdag-verify diff $name.svdag back.svdag -q
>     svdag-verify vdb $name.svdag $name.vdb -q
>   done
>   svdag export $name.svdag -o $name.nvdb
> done
| tiny.nvdb: nvdb, 1,201 voxels of level 7 (128^3)
| box.nvdb: nvdb, 2,879 voxels of level 6 (64^3)
| far.nvdb: nvdb, 2,940 voxels of level 7 (128^3)
| farbox.nvdb: nvdb, 2,576 voxels of level 6 (64^3)
$ cat before
|     "corner": [
|       1841111.3998412697,
|       5176075.29984127,
|       191.09984126984128
|     ],
|     "voxel_size": 0.0003174603174604799,

## export_wrong_requests
# Wrong requests: one message each, exit code 2.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag export a.svdag -o a.txt
! svdag: a.txt: unknown file extension: choose a format with --format: vdb, nvdb, hashdag, symvox, transform-dag, octree, npz, binvox, vox, ply, glb, obj, stl, ply-surface
? 2
$ svdag export a.svdag -o a.vdb --format foo
! svdag: --format: unknown format "foo": choose one of vdb, nvdb, hashdag, symvox, transform-dag, octree, npz, binvox, vox, ply, glb, obj, stl, ply-surface
? 2
$ svdag export a.svdag -o a.vdb --level 7
! svdag: --level 7: a.svdag has the levels 3 to 6
? 2
$ svdag export a.svdag -o a.vdb --bounds=1,2,3
! svdag: --bounds: "1,2,3" is not x0,y0,z0,x1,y1,z1 with the minimum first
? 2
$ svdag export a.svdag -o a.svdag --format vdb
! svdag: a.svdag is also an input, which is never overwritten: choose another output
? 2
$ svdag export a.svdag -o a.vdb --max-voxels 3
! svdag: --max-voxels: only npz, binvox, vox and ply list voxels, the format is vdb
? 2
$ svdag export a.svdag
! svdag: --output is required; see svdag export --help
? 2
$ svdag export none.svdag -o a.vdb
! svdag: none.svdag: cannot be opened: no such file or folder
? 3
$ ls
| a.ply
| a.svdag
# Every file that a format writes is checked, not only the named one.
$ cp a.svdag x.octreenodes
$ cp a.svdag y.svdag
$ ln -s y.svdag y.octreedata
$ svdag export x.octreenodes --format octree -o x.octree
! svdag: x.octreenodes is also an input, which is never overwritten: choose another output
? 2
$ svdag export y.svdag -o y.octree
! svdag: y.octreedata is also an input, which is never overwritten: choose another output
? 2
$ cmp a.svdag x.octreenodes
$ cmp a.svdag y.svdag
$ ls
| a.ply
| a.svdag
| x.octreenodes
| y.octreedata
| y.svdag

## export_stored_colours
# Stored colours are exported; a vox says what its palette costs.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o plain.svdag -r 128
$ paint_dag plain.svdag painted.svdag 7 9
$ svdag export painted.svdag -o a.vox
| a.vox: vox, 75,650 voxels of level 7 (128^3), 869 colours as 255, off by at most 16.8 of 255 steps
$ svdag export painted.svdag -o a.vox --json --level 5
| {
|   "output": "a.vox",
|   "format": "vox",
|   "level": 5,
|   "resolution": 32,
|   "voxels": 3173,
|   "palette": {
|     "colours": 601,
|     "entries": 255,
|     "largest_error": 8.660254037844387
|   }
| }
$ svdag export painted.svdag -o a.ply && head -c 400 a.ply | grep -a property
| a.ply: ply, 75,650 voxels of level 7 (128^3)
| property double x
| property double y
| property double z
| property uchar red
| property uchar green
| property uchar blue
$ svdag export painted.svdag -o a.npz -q && python3 -m zipfile -l a.npz | grep -o '[a-z_]*.npy'
| coordinates.npy
| resolution.npy
| corner.npy
| voxel_size.npy
| colours.npy
$ svdag export painted.svdag -o a.basic_dag.dag.bin --colours -q && ls *.bin
| a.basic_dag.dag.bin
| a.basic_dag.uncompressed_colors.bin
$ svdag export plain.svdag -o b.basic_dag.dag.bin --colours
! svdag: --colours: plain.svdag has neither colours nor layers (svdag build --colours, --layers)
? 2
$ svdag convert painted.svdag -o bare.svdag --no-colours -q && svdag export bare.svdag -o b.vox -q && svdag export plain.svdag -o c.vox -q && cmp b.vox c.vox && echo same
| same

## export_surface
# The surface of voxels as a mesh: quads that are merged where they have one colour, closed, placed in the world.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag export a.svdag -o a.glb
| a.glb: glb, 17,099 voxels of level 6 (64^3), 22,510 faces as 2,325 quads
$ svdag export a.svdag -o a.obj --no-merge
| a.obj: obj, 17,099 voxels of level 6 (64^3), 22,510 faces as 22,510 quads
$ svdag export a.svdag -o a.stl --level 5 --json
| {
|   "output": "a.stl",
|   "format": "stl",
|   "level": 5,
|   "resolution": 32,
|   "voxels": 3015,
|   "faces": 4002,
|   "quads": 588,
|   "vertices": 778
| }
$ svdag export a.svdag -o b.ply --format ply-surface -q && head -3 b.ply | cat -A | tr -s ' '
| ply$
| format binary_little_endian 1.0$
| comment surface of voxels of side 1.5238095238095237 $
$ svdag build a.glb -r 64 --rule solid -o c.svdag | sed -n 1p | cut -d, -f1-2
| c.svdag: 64^3, 4
$ svdag export a.svdag -o c.glb --max-quads 100
! svdag: the surface has 2,325 quads, more than 100: export a coarser --level, a part with --bounds, or raise --max-quads
? 2
$ svdag export a.svdag -o a.npz --no-merge
! svdag: --no-merge: only glb, obj, stl and ply-surface are surfaces, the format is npz
? 2
$ svdag export a.svdag -o a.npz --max-quads 10
! svdag: --max-quads: only glb, obj, stl and ply-surface are surfaces, the format is npz
? 2

# Distances are dense arrays of a window, negative in solids; only npz holds them.
$ svdag build a.glb -r 64 --rule solid -o c.svdag -q
$ svdag export c.svdag -o d.npz --distance 3 --level 5 --json
| {
|   "output": "d.npz",
|   "format": "npz",
|   "level": 5,
|   "resolution": 32,
|   "voxels": 4198,
|   "distances": 32768
| }
$ svdag export c.svdag -o d.npz --distance 64 && python3 -m zipfile -l d.npz | grep -o '[a-z_]*.npy'
| d.npz: npz, 27,397 voxels of level 6 (64^3), 262,144 distances
| distance.npy
| corner.npy
| voxel_size.npy
| limit.npy
$ svdag export d.npz -o back.svdag
! svdag: d.npz is not named .svdag: svdag import reads other formats
? 2
$ svdag export c.svdag -o d.npz --distance 65
! svdag: --distance: "65" is not a number from 1 to 64; see svdag export --help
? 2
$ svdag export c.svdag -o d.vox --distance 3
! svdag: --distance: only npz holds distances, the format is vox
? 2
$ svdag export c.svdag -o d.npz --distance 3 --max-voxels 1K
! svdag: there are 262,144 distances to write, more than 1,024: export a coarser --level, a part with --bounds, or raise --max-voxels
? 2
$ svdag export c.svdag -o d.npz --distance 3 -m 1M
! svdag: the distances need 2 MiB in total, but the memory budget is 1 MiB: raise --memory
? 5
