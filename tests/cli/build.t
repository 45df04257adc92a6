# Whole bakes: the same bytes in every way of baking, --check, --cache, --solid.

## build_and_check
# The whole workflow: bake, check, compare every voxel, print information.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 64 -o r.svdag -q
$ svdag-verify check r.svdag -q
$ svdag-verify mesh r.svdag r.ply -q
$ svdag info r.svdag --levels
| r.svdag: 64^3 voxels, rule conservative
|   voxel size 1.7142857142857142, corner (-54.857142857142854, -24.857142857142858, -54.857142857142854)
|   occupied: voxels 0 .. 63, 0 .. 28, 0 .. 63; (-54.8571429, -24.8571429, -54.8571429) to (54.8571429, 24.8571429, 54.8571429)
|   4,984 voxels set, 1,730 SVO nodes, 268 DAG nodes (298 with 2x2x2 leaves)
|   4.9 KiB, 8.13 bits per voxel; as SVO 1.7 KiB
|   content hash 711bdc76be5527a8286a550aa811a677
|
|   level          SVO nodes      DAG nodes          bytes     if compact
|       0                  1              1             20            320
|       1                  4              4            104            320
|       2                 22             22            456            320
|       3                 92             90          1,696            512
|       4                336            151          1,208          1,208  (4x4x4 bricks)
|       5              1,275             30                                (2x2x2 blocks, inside the bricks)

## build_cache
# A second bake takes every cell from the cache; another rule takes none.
$ svdag-scene city -n 6K -q -o city.ply
$ svdag build city.ply -r 1K -q -o plain.svdag
$ for name in first second; do
>   svdag build city.ply -r 1K -v -o $name.svdag --cache cells | grep cells
>   cmp plain.svdag $name.svdag
> done
|   483 cells visited, 0 of them found in the cache
|   483 cells visited, 483 of them found in the cache
$ svdag build city.ply -r 1K --rule thin -v -o thin.svdag --cache cells | grep cells
|   483 cells visited, 0 of them found in the cache
$ svdag build city.ply -r 1K -q -o x.svdag --cache-size 1G
! svdag: --cache-size requires --cache; see svdag build --help
? 2

## build_cache_folder
# An existing folder keeps its permissions; a world-writable one is rejected.
$ svdag-scene city -n 3K -q -o city.ply
$ mkdir group everybody
$ chmod 2775 group
$ chmod 1777 everybody
$ svdag build city.ply -r 256 -q -o a.svdag --cache group
$ svdag build city.ply -r 256 -q -o b.svdag --cache everybody
! svdag: everybody: this folder is world-writable, and its files would be trusted: choose one of your own, or of your group
? 2
$ svdag build city.ply -r 256 -q -o c.svdag --cache new
$ stat -c '%a %n' group everybody new
| 2775 group
| 1777 everybody
| 700 new
$ ls everybody
$ ls *.svdag
| a.svdag
| c.svdag

## build_known_bytes
# Known hashes of two bakes: detects a change of the format or of a voxel decision.
$ svdag-scene rectangle -q -o r.ply
$ svdag build r.ply -r 128 -o box.svdag -q
$ svdag build r.ply -s 0.75 -o lattice.svdag -q
$ sha256sum box.svdag lattice.svdag
| 2bc4fb2b821f03c92e2a90bc67f9acb52da88083092cb78aecfcf312d009a184  box.svdag
| 05ddb1c4d3bbcbf15be7205132f507f086b8f68e898a7b58911eafef46455882  lattice.svdag

## build_little_memory
$ svdag-scene hairball -n 1M -q -o h.ply
$ svdag build h.ply -r 1K -m 1M -o h.svdag
! svdag: the triangles need 2 MiB in total, but the memory budget is 1 MiB: raise --memory
? 5

## build_no_plane_memo
# Without the plane memo and with every instruction set, the bytes are the same.
$ svdag-scene city -n 6K --yaw 30 -q -o city.ply
$ svdag build city.ply -r 1K -o best.svdag --report best.json -q
$ svdag build city.ply -r 1K -o alone.svdag --report alone.json -q --no-plane-memo
$ cmp best.svdag alone.svdag
$ names=$(svdag build city.ply -r 64 -o none.svdag --vectors none 2>&1 | sed 's/.*choose one of //; s/,//g')
$ for name in $names; do
>   svdag build city.ply -r 1K -o same.svdag --report report.json -q --vectors "$name"
>   cmp best.svdag same.svdag
> done
$ svdag build city.ply -r 1K -o same.svdag -q --vectors PLAIN
$ python3 -c '
> import json
> best, alone, plain = (json.load(open(f"{name}.json")) for name in ["best", "alone", "report"])
> print("computed with the memo:", best["plane_memo"]["computed"] > 0, "without:", alone["plane_memo"]["computed"])
> print(plain["vectors"], plain["lanes"], "vectors differ:", plain["vectors"] != best["vectors"])'
| computed with the memo: True without: 0
| plain 1 vectors differ: True

## build_same_bytes
# Threads and the order of triangles do not affect the bytes.
$ svdag-scene city -n 6K --yaw 30 -q -o plain.ply
$ svdag-scene city -n 6K --yaw 30 --shuffle -q -o shuffled.ply
$ svdag build plain.ply -r 256 -j 1 -o one.svdag -q
$ svdag build plain.ply -r 256 -j 4 -o four.svdag -q
$ svdag build shuffled.ply -r 256 -j 3 -o shuffled.svdag -q
$ cmp one.svdag four.svdag
$ cmp one.svdag shuffled.svdag
$ sha256sum one.svdag
| cca0817398cb8946570c0542dbf3f102e8546fdf19938991ec59b78097946b99  one.svdag

## solid
# Rule solid: closed surfaces are filled; every way of baking gives the same bytes.
$ cat > box.obj <<END
> o box
> v 0 0 0
> v 1 0 0
> v 1 1 0
> v 0 1 0
> v 0 0 1
> v 1 0 1
> v 1 1 1
> v 0 1 1
> f 1 4 3 2
> f 5 6 7 8
> f 1 2 6 5
> f 2 3 7 6
> f 3 4 8 7
> f 4 1 5 8
> END
$ svdag build box.obj -o box.svdag -r 64 --rule solid | sed 's/, [0-9.]* s$//'
| box.svdag: 64^3, 12 triangles, 262,144 voxels, 5 nodes, 1.7 KiB (0.053 bits per voxel)
|   the surface encloses 250,047 voxels
$ svdag info box.svdag | head -1
| box.svdag: 64^3 voxels, rule solid
$ svdag-verify check box.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag-verify mesh box.svdag box.obj | tail -3
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag-verify mesh box.svdag box.obj --sample 100 | grep anywhere
| drawn      100 points anywhere, 0 in wrong bricks, so at most 2.95 % of the selection
$ svdag-verify mesh box.svdag box.obj --judge cgal -q
$ svdag-verify trace box.svdag box.obj --rays 10000 -q
$ svdag-scene scan -n 20K -q -o scan.ply
$ svdag build scan.ply -o scan.svdag -r 256 --rule solid -q
$ svdag-verify mesh scan.svdag scan.ply | tail -1
| ok: every voxel agrees with the scene
$ svdag build scan.ply -o small.svdag -r 256 --rule solid -q -m 8M && cmp scan.svdag small.svdag
$ for i in 1 2 3; do svdag build scan.ply -o "$i.run" -r 256 --rule solid -q --part "$i/3"; done
$ svdag merge 3.run 1.run 2.run -q -o merged.svdag && cmp scan.svdag merged.svdag
$ svdag plan scan.ply -o scan.plan -r 256 --rule solid --shards 2 -q && svdag run scan.plan -q && cmp scan.svdag scan.plan/*.svdag
$ for i in 1 2; do svdag build scan.ply -o cached.svdag -r 256 --rule solid -q --cache cells && cmp scan.svdag cached.svdag; done
# What is not closed.
$ sed '$d' box.obj > open.obj
$ svdag build open.obj -o open.svdag -r 64 --rule solid
! svdag: the scene is not closed: 4 open edges in box, the first at (0, 1, 0): repair it, or bake its open parts as surfaces with --open surface
? 3
$ svdag build open.obj -o open.svdag -r 64 --rule solid --open surface | sed 's/, [0-9.]* s$//'
| open.svdag: 64^3, 10 triangles, 19,972 voxels, 60 nodes, 2.9 KiB (1.18 bits per voxel)
|   open parts, baked as surfaces: 1
$ svdag-verify mesh open.svdag open.obj -q
$ sed 's/f 1 4 3 2/f 1 2 3 4/' box.obj > turned.obj
$ svdag build turned.obj -o turned.svdag -r 64 --rule solid
! svdag: the triangles of the scene are not oriented alike at 4 edges in box, the first at (1, 0, 0): give --inside odd
? 3
$ svdag build turned.obj -o turned.svdag -r 64 --rule solid --inside odd | sed 's/, [0-9.]* s$//'
| turned.svdag: 64^3, 12 triangles, 262,144 voxels, 5 nodes, 1.7 KiB (0.053 bits per voxel)
$ svdag info turned.obj | tail -2
|   0 open edges, 0 non-manifold edges
|   closed at 64K^3, but not oriented alike at 4 edges in box, the first at (1, 0, 0)
$ svdag-verify diff box.svdag turned.svdag
| compared  at 64^3, 4 pairs of nodes
| both      262,144 voxels
| only A    0
| only B    0
| clusters  0
| same
# A scene too small for a grid is neither closed nor open.
$ printf 'v 0 0 0\nv 1e-310 0 0\nv 0 1e-310 0\nf 1 2 3\n' > tiny.obj
$ svdag info tiny.obj | tail -1
|   0 open edges, 0 non-manifold edges
# What cannot be.
$ svdag build box.obj -o x.svdag -r 64 --rule full
! svdag: --rule: unknown rule "full": choose conservative, thin or solid
? 2
$ svdag build box.obj -o x.svdag -r 64 --inside odd
! svdag: --inside needs --rule solid
? 2
$ svdag build box.obj -o x.svdag -r 64 --rule solid --inside all
! svdag: --inside: unknown kind "all": choose nonzero or odd
? 2
$ svdag build box.obj -o x.svdag -r 64 --rule solid --open ignore
! svdag: --open: unknown kind "ignore": choose error or surface
? 2
$ svdag-verify mesh box.svdag box.obj --judge openvdb
! svdag-verify: --judge openvdb: judges surfaces: choose integer or cgal for rule solid
? 2
$ svdag build box.obj -o x.svdag -r 64 --open surface
! svdag: --open needs --rule solid
? 2
# Layers: two boxes, one in the other; the wall of a third is open.
$ svdag-scene atrium -q -o atrium.obj
$ svdag build atrium.obj -o a.svdag -r 256 --rule solid --layers object --open surface -q && svdag-verify check a.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag-verify mesh a.svdag atrium.obj | tail -1
| ok: every voxel agrees with the scene
$ svdag build scan.ply box.obj -o two.svdag -r 128 --rule solid --layers file | sed 's/, [0-9.]* s$//'
| two.svdag: 128^3, 19,212 triangles, 432,513 voxels, 3,218 nodes, 44.2 KiB (0.837 bits per voxel)
|   the surface encloses 402,230 voxels
$ svdag info two.svdag --layers | tail -3
|               voxels          nodes      own nodes  colour   layer
|                   12              6              6  #f2d0ae  box.obj
|              432,513          3,212              0  #9e634f  scan.ply
$ svdag-verify mesh two.svdag scan.ply box.obj | tail -3
| extra      0
| layers     2 layers agree
| ok: every voxel agrees with the scene
$ svdag build scan.ply box.obj -o small.svdag -r 128 --rule solid --layers file -m 8M -q && cmp two.svdag small.svdag
$ svdag build scan.ply open.obj -o mixed.svdag -r 128 --rule solid --open surface --layers file | sed 's/, [0-9.]* s$//'
| mixed.svdag: 128^3, 19,210 triangles, 432,513 voxels, 3,218 nodes, 44.2 KiB (0.837 bits per voxel)
|   the surface encloses 402,229 voxels
|   open parts, baked as surfaces: 1
|   open layers, baked as surfaces: 1
$ svdag-verify mesh mixed.svdag scan.ply open.obj | tail -3
| extra      0
| layers     2 layers agree
| ok: every voxel agrees with the scene
$ svdag-verify mesh mixed.svdag scan.ply open.obj --sample 100 | tail -1
| ok: no sampled voxel differs
