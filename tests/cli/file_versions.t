# Files of other versions of the format.

## format_other_version
# A file of an unknown version is reported as such, not as damaged.
$ later() { head -c 8 "$TESTS/files/$1"; printf "$2"; tail -c +10 "$TESTS/files/$1"; }
$ later version1.svdag '\004' > later_version1.svdag
$ later version1_half1.run '\002' > later_version1_half1.run
$ svdag info later_version1.svdag
! svdag: later_version1.svdag: has format version 4, this program reads versions 1 to 3
? 3
$ svdag-verify check later_version1.svdag
! svdag-verify: later_version1.svdag: has format version 4, this program reads versions 1 to 3
? 3
$ svdag merge later_version1_half1.run "$TESTS/files/version1_half2.run" -o merged.svdag
! svdag: later_version1_half1.run: has run format version 2, this program reads version 1
? 3

## format_version1
# Stored files of format version 1: every later version reads the same voxels from them.
$ svdag info "$TESTS/files/version1.svdag" | sed "s|$TESTS/||"
| files/version1.svdag: 32^3 voxels, rule conservative
|   voxel size 3.2308551419165825, corner (-42.196940022130164, -46.13788850845829, -42.39643343033329)
|   occupied: voxels 0 .. 23, 0 .. 31, 0 .. 24; (-42.19694, -46.1378885, -42.3964334) to (35.3435834, 57.249476, 38.3749451)
|   3,093 voxels set, 999 SVO nodes, 222 DAG nodes (321 with 2x2x2 leaves)
|   3.9 KiB, 10.4 bits per voxel; as SVO 999 bytes
|   content hash 88dfeada0c65f378e6457d957096a435
$ svdag-verify check "$TESTS/files/version1.svdag" | sed "s|$TESTS/||"
| grid    32^3 box, voxel size 3.2308551419165825, corner (-42.196940022130164, -46.13788850845829, -42.39643343033329), rule conservative
| bytes   4,040 in 1 blocks, all checksums match
| nodes   222 on 4 levels, 177 of them bricks
| voxels  3,093
| ok: sound, in canonical order and minimal
$ svdag export "$TESTS/files/version1.svdag" -q -o voxels.ply
$ sha256sum voxels.ply
| 7bfa78532f33b4046d9738dbb71d35d9c8c959a38d31b2d294c27ed7ba5a4abd  voxels.ply
$ svdag info "$TESTS/files/version1_half1.run" | sed "s|$TESTS/||"
| files/version1_half1.run: a run of 50 % of 32^3 voxels, rule conservative
|   voxel size 3.2308551419165825, corner (-42.196940022130164, -46.13788850845829, -42.39643343033329)
|   2,046 voxels set, 143 nodes, 4 roots, 3.0 KiB
|   content hash 25a7091905ca839a3baa97721e9506b1
$ svdag merge "$TESTS/files/version1_half1.run" "$TESTS/files/version1_half2.run" -q -o merged.svdag
$ cmp merged.svdag "$TESTS/files/version1.svdag" && echo "the runs make the file"
| the runs make the file
