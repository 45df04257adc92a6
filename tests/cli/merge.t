# svdag merge.

## merge_any_tree
# Parts baked separately, with other threads and memory, merged in any tree, equal the bake of the whole.
$ svdag-scene city -n 6K --yaw 30 -q -o c.ply
$ svdag build c.ply -r 256 -o whole.svdag -q
$ svdag build c.ply -r 256 -o whole.run -q
$ for i in 1 2 3 4 5; do svdag build c.ply -r 256 --part $i/5 -o $i.run -j $i -m $((i * 40))M -q; done
$ svdag merge 4.run 2.run -o a.run
| a.run: 256^3, 2 runs (38.5 KiB), 75,288 voxels, 2,331 nodes, 35.0 KiB, content f72d1cf26e88c4cd226e34b36ca204ca
$ svdag merge 5.run a.run 1.run -o b.run -q -m 8M
$ svdag merge b.run 3.run -o merged.svdag
| merged.svdag: 256^3, 2 runs (81.9 KiB), 179,339 voxels, 4,755 nodes, 66.3 KiB, content 01d310c4caeda8b8383ecff2bef0be92
$ svdag merge 3.run b.run -o merged.run -q -j 1
$ cmp whole.svdag merged.svdag
$ cmp whole.run merged.run
$ svdag-verify mesh merged.svdag c.ply
| grid       256^3 box, voxel size 0.5142683440563726, corner (-65.82634803921569, -1.2571341720281863, -65.82634803921569), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  6,000
| bricks     7,200 (all), 0 wrong
| voxels     179,339 in the file, 179,339 by the judge
| missing    0
| extra      0
| ok: every voxel agrees with the scene

## merge_broken
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.run -q
$ printf X | dd of=r.run bs=1 seek=1100 conv=notrunc status=none
$ echo old > out.svdag
$ svdag merge r.run -o out.svdag
! svdag: r.run: damaged run: a block does not match its checksum (at byte 1024)
? 3
$ cat out.svdag
| old
$ ls
| out.svdag
| r.ply
| r.run

## merge_info
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 --part 2/3 -o r.run -q
$ svdag info r.run
| r.run: a run of 32.81 % of 64^3 voxels, rule conservative
|   voxel size 1.7142857142857142, corner (-54.857142857142854, -24.857142857142858, -54.857142857142854)
|   1,810 voxels set, 122 nodes, 3 roots, 3.1 KiB
|   content hash 33ac77983f4d0a777d70404b1a784780
$ svdag info r.run --json
| {
|   "format": "run",
|   "version": 1,
|   "levels": 6,
|   "resolution": 64,
|   "rule": "conservative",
|   "voxels": 1810,
|   "largest_snap": 7.105427357601002e-15,
|   "ranges": [
|     [
|       86016,
|       172032
|     ]
|   ],
|   "nodes": [
|     0,
|     1,
|     7,
|     31,
|     83
|   ],
|   "roots": 3,
|   "file_bytes": 3216,
|   "content_hash": "33ac77983f4d0a777d70404b1a784780"
| }

## merge_known_bytes
# Known hashes of runs: detects a change of the format.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 128 -o box.run -q
$ svdag build r.ply -s 0.75 --part 2/3 -o lattice.run -q
$ sha256sum box.run lattice.run
| bb4742bc99a1509f5acfded824e609e6a96e93e7fdcee808c59197ad3ba0567d  box.run
| fbf363d4582d12fdf94e9db77fd747e2f83bec70b934f4bd9762fd060f7d4772  lattice.run

## merge_missing_part
$ svdag-scene rectangle -q -o r.ply
$ for i in 1 3; do svdag build r.ply -r 64 --part $i/3 -o $i.run -q; done
$ svdag merge 1.run 3.run -o out.svdag
! svdag: out.svdag: the runs do not cover the grid: the 16^3 voxels from (16, 32, 16) on are missing: add the missing run, or merge to a .run
? 2

## merge_not_a_run
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ svdag merge r.svdag -o out.svdag
! svdag: r.svdag: is not a run (its first bytes are not \x89SVRUN)
? 3

## merge_other_bakes
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -s 0.75 --part 1/2 -o a.run -q
$ svdag build r.ply -s 0.7 --part 2/2 -o b.run -q
$ svdag merge a.run b.run -o out.svdag
! svdag: a.run and b.run are from different bakes: the voxel size differs
? 2

## merge_over_its_input
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.run -q
$ svdag merge r.run -o ./r.run
! svdag: ./r.run is also an input, which is never overwritten: choose another output
? 2

## merge_overlap
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 --part 2/3 -o a.run -q
$ svdag build r.ply -r 64 --part 1/2 -o b.run -q
$ svdag merge a.run b.run -o out.svdag
! svdag: b.run and a.run overlap: both hold voxel (16, 32, 16)
? 2

## merge_truncated
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.run -q
$ head -c 1500 r.run > short.run
$ svdag merge short.run -o out.svdag
! svdag: short.run: damaged run: its size differs from the size in its header (at byte 312)
? 3

## merge_twice
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 --part 1/2 -o r.run -q
$ svdag merge r.run ./r.run -o out.run
! svdag: ./r.run is given twice
? 2
