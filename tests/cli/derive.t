# svdag edit, convert, pack and unpack.

## convert
# A file converts to the compact layout and back, byte for byte; every program takes either.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o plain.svdag -r 256
$ svdag convert plain.svdag -o small.svdag --layout compact
| small.svdag: compact, 16.8 KiB, 33.3 % of plain.svdag
|   content hash aafedd7df55db32481ca8b216032456e
$ svdag convert small.svdag -q -o back.svdag --layout plain && cmp plain.svdag back.svdag
$ svdag build city.ply -q -o built.svdag -r 256 --layout compact && cmp small.svdag built.svdag
$ svdag build city.ply -q -o a.run -r 256 --part 1/2 && svdag build city.ply -q -o b.run -r 256 --part 2/2
$ svdag merge a.run b.run -q -o merged.svdag --layout compact && cmp small.svdag merged.svdag
$ svdag edit plain.svdag -q -o whole.svdag --bounds=-1e9,-1e9,-1e9,1e9,1e9,1e9 --layout compact
$ svdag-verify diff whole.svdag plain.svdag -q && echo "the edit has the same voxels"
| the edit has the same voxels
$ svdag export small.svdag -q -o small.npz && svdag import small.npz -q -o imported.svdag --layout compact
$ svdag export small.svdag -q -o small.svo && svdag export plain.svdag -q -o plain.svo && cmp small.svo plain.svo
$ svdag-verify diff small.svdag imported.svdag -q && echo "the import has the same voxels"
| the import has the same voxels
$ svdag-verify check small.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag-verify mesh small.svdag city.ply -q && echo "the judge agrees"
| the judge agrees
$ for file in plain small; do svdag-trace "$file.svdag" --size 64x64 --samples 2 --rounds 1 | tail -1; done | uniq | wc -l
| 1
$ svdag info small.svdag --levels | tail -3
|       5              3,162          1,311          7,680         29,536
|       6             14,688            370          2,960          2,960  (4x4x4 bricks)
|       7             74,982             43                                (2x2x2 blocks, inside the bricks)
$ svdag convert plain.svdag -o plain.svdag --layout compact
! svdag: plain.svdag is also an input, which is never overwritten: choose another output
? 2
$ svdag convert plain.svdag -o other.svdag
! svdag: convert: give --layout, --layer, --level, --bounds, --palette or --no-colours
? 2
$ svdag build city.ply -o a.run -r 64 --layout compact
! svdag: --layout: a .run has no layout: choose it when merging
? 2

## edit
# Union, intersection, difference, crop and a coarser level: the same bytes as a bake of these voxels.
$ svdag-scene speck -n 300 -q -o a.ply
$ printf 'OFF\n3 1 0\n-60 -50 -40\n60 40 30\n0 60 -60\n3 0 1 2\n' > b.off
$ cube='--cube=-70,-70,-70,140'
$ for s in a.ply b.off; do svdag build $s -r 256 $cube -q -o ${s%.*}.svdag; done
$ svdag build a.ply b.off -r 256 $cube -q -o ab.svdag
$ svdag edit a.svdag b.svdag -o union.svdag --union && cmp union.svdag ab.svdag && echo "the union is the bake of both"
| union.svdag: 256^3, 40,585 voxels, 693 nodes, 13.0 KiB
|   content hash db24aa7dbcbfd2e2295b43646b73de53
| the union is the bake of both
$ svdag edit ab.svdag b.svdag -o rest.svdag --difference -q && svdag edit a.svdag b.svdag -o common.svdag --intersection -q
$ svdag edit a.svdag common.svdag -o a_only.svdag --difference -q
$ svdag-verify diff rest.svdag a_only.svdag -q && echo "(a or b) without b is a without (a and b)"
| (a or b) without b is a without (a and b)
$ svdag edit rest.svdag common.svdag -o again.svdag --union -q && svdag-verify diff again.svdag a.svdag -q && echo "both parts are a"
| both parts are a
$ box='--bounds=-33.3,-20,-5,21,40.4,52'
$ svdag build a.ply b.off -r 256 $cube $box -q -o baked.svdag
$ svdag edit ab.svdag -o cropped.svdag $box -q && svdag-verify diff cropped.svdag baked.svdag -q && echo "the crop is the bake with --bounds"
| the crop is the bake with --bounds
$ svdag edit a.svdag b.svdag -o both.svdag --union $box -q && cmp both.svdag cropped.svdag
$ svdag edit ab.svdag -o coarse.svdag --level 6 && svdag-verify diff coarse.svdag ab.svdag -q && echo "the level is the same scene"
| coarse.svdag: 64^3, 2,650 voxels, 220 nodes, 3.9 KiB
|   content hash 37bfa99f4bbb660e7447e91bba651dd4
| the level is the same scene
# A box of the coarser level, in every way to get it.
$ svdag edit coarse.svdag -o part.svdag $box -q && svdag info part.svdag | sed -n 4p
|   149 voxels set, 86 SVO nodes, 38 DAG nodes (60 with 2x2x2 leaves)
$ svdag edit ab.svdag -o x.svdag --level 6 $box -q && cmp x.svdag part.svdag
$ svdag convert ab.svdag -o x.svdag --level 6 $box -q && cmp x.svdag part.svdag
$ svdag convert part.svdag -o small.svdag --layout compact -q
$ svdag convert ab.svdag -o x.svdag --level 6 $box --layout compact -q && cmp x.svdag small.svdag
$ for end in basic_dag.dag.bin svo octree; do
>   svdag export ab.svdag -o x.$end --level 6 $box -q && svdag export part.svdag -o y.$end -q && cmp x.$end y.$end
> done
$ svdag pack cropped.svdag -o x.pack -q && svdag pack ab.svdag -o y.pack $box -q && cmp x.pack y.pack
$ svdag-verify diff ab.svdag coarse.svdag --level 6 $box | tail -1
| same
$ svdag-verify render ab.svdag -o x.png $box --size 64x36 -q && svdag-verify render cropped.svdag -o y.png --size 64x36 -q && cmp x.png y.png
# Below 64K, a bake of the level itself may have other voxels near voxel planes.
$ svdag build a.ply b.off -r 64 $cube -q -o 64.svdag
$ svdag-verify diff 64.svdag coarse.svdag -q
? 1
$ svdag edit a.svdag a.svdag -o none.svdag --difference | head -1
| none.svdag: 256^3, 0 voxels, 0 nodes, 1.3 KiB
$ for f in union rest common cropped coarse none; do svdag-verify check $f.svdag | tail -1; done
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
# What makes no sense is refused.
$ svdag edit a.svdag -o x.svdag
! svdag: nothing to do: give --level, --bounds, --layer, or a second .svdag and an operation
? 2
$ svdag edit a.svdag b.svdag -o x.svdag
! svdag: b.svdag: choose --union, --intersection or --difference
? 2
$ svdag edit a.svdag -o x.svdag --union
! svdag: a union, intersection or difference needs a second .svdag
? 2
$ svdag edit a.svdag b.svdag -o x.svdag --union --difference
! svdag: give only one of --union or --intersection or --difference; see svdag edit --help
? 2
$ svdag edit a.svdag 64.svdag -o x.svdag --union
! svdag: a.svdag and 64.svdag differ in their resolution: 256 and 64
? 2
$ svdag build b.off -r 256 --cube=-70,-70,-70,141 -q -o c.svdag; svdag edit a.svdag c.svdag -o x.svdag --union
! svdag: a.svdag and c.svdag differ in their voxel size: 0.546875 and 0.55078125
? 2
$ svdag build b.off -r 256 $cube --rule thin -q -o t.svdag; svdag edit a.svdag t.svdag -o x.svdag --union
! svdag: a.svdag and t.svdag differ in their rule: conservative and thin
? 2
$ svdag edit a.svdag -o x.svdag --level 9
! svdag: --level 9: a.svdag has the levels 3 to 8
? 2
$ svdag edit a.svdag b.svdag -o x.svdag --union --level 5
! svdag: --level: coarsen the result in a second edit
? 2
$ svdag edit a.svdag -o x.svdag --bounds=900,0,0,901,1,1
! svdag: --bounds: the box meets no voxel of the grid that may be set
? 2
$ svdag edit a.svdag -o a.svdag --level 5
! svdag: a.svdag is also an input, which is never overwritten: choose another output
? 2
$ svdag edit a.svdag -o a.vdb --level 5
! svdag: a.vdb: the output must end in .svdag: use svdag export for other formats
? 2
$ svdag edit a.svdag b.svdag -o union.svdag --union -n
! svdag: union.svdag: already exists: choose another name, or omit --no-clobber
? 2

## pack
# A packed file unpacks byte for byte, and is taken in place of a .svdag; damage is found and named.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o city.svdag -r 256
$ svdag convert city.svdag -q -o small.svdag --layout compact
$ svdag pack city.svdag -o city.svdag.pack
| city.svdag.pack: 13.6 KiB, 26.9 % of the plain 50.4 KiB
|   content hash aafedd7df55db32481ca8b216032456e
$ svdag pack small.svdag -q -o small.pack && cmp city.svdag.pack small.pack && echo "every layout packs to the same bytes"
| every layout packs to the same bytes
$ svdag unpack city.svdag.pack -o again.svdag
| again.svdag: 50.4 KiB
|   content hash aafedd7df55db32481ca8b216032456e
$ cmp city.svdag again.svdag && echo same
| same
$ svdag info city.svdag.pack  # by its header
| city.svdag.pack: 256^3 voxels, rule conservative, packed
|   voxel size 0.3764705882352941, corner (-48.188235294117646, -1.188235294117647, -48.188235294117646)
|   330,308 voxels set, 2,355 DAG nodes (more with --levels or --json, which unpack it)
|   13.6 KiB, 0.337 bits per voxel; unpacked 50.4 KiB
|   content hash aafedd7df55db32481ca8b216032456e
$ svdag info city.svdag.pack --json | grep bits_per
|   "bits_per_voxel": 1.251098974290662,
$ svdag-verify check city.svdag.pack | tail -1
| ok: sound, in canonical order and minimal
$ svdag-verify diff city.svdag.pack city.svdag -q && echo "the same voxels"
| the same voxels
$ svdag edit city.svdag.pack -q -o coarse.svdag --level 6 && svdag info coarse.svdag | head -1
| coarse.svdag: 64^3 voxels, rule conservative
$ svdag-trace city.svdag.pack
! svdag-trace: city.svdag.pack: is packed: trace the result of svdag unpack
? 3
$ svdag pack city.svdag -o city.zst
! svdag: city.zst: the output must end in .pack
? 2
$ svdag unpack city.svdag -o other.svdag
! svdag: city.svdag: is not a packed file
? 3
$ { head -c 2000 city.svdag.pack; printf X; tail -c +2002 city.svdag.pack; } > bad.pack
$ svdag unpack bad.pack -o bad.svdag
! svdag: bad.pack: damaged file: a chunk does not match its checksum (at byte 1072)
? 3
$ test ! -e bad.svdag && echo "no output"
| no output
$ head -c 3000 city.svdag.pack > short.pack; svdag unpack short.pack -o bad.svdag
! svdag: short.pack: damaged file: the index is not at the end (at byte 24)
? 3
