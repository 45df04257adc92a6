# svdag-verify trace.

## verify_trace
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag build a.ply -r 512 -o a.svdag -q
$ svdag-verify trace a.svdag a.ply --rays 20K
|* grid        512^3 box, voxel size *, corner *, rule conservative, matches the scene's bounds
| judge       embree: its hits and distances, rechecked in double
| triangles   4,800
| in grid     4,800 triangles
|* rays        20,480, 10,* hit both, 9,* neither, 0 only triangles, [34]?? only voxels
|* one side    * of kind camera, * per million, 4,096 rays
|* one side    * of kind chord, * per million, 4,096 rays
|* one side    * of kind inside, * per million, 4,096 rays
|* one side    * of kind axis, * per million, 4,096 rays
|* one side    * of kind surface, * per million, 4,096 rays
|* late        0 triangle hits have no voxel at or before them, 10,* judged, * doubtful, within 4.6e-10 voxels of an edge
|* far         0 voxels are too far from the scene, more than 0.8660 voxels, 13,* judged
| uncovered   0 points of the surface are more than 0.8660 voxels from a voxel, 2,048 judged
| nearer      the voxel's hit is nearer than the triangle's by ... voxels:
|   < -1      0
|   -1 .. 0   0
|*   0 .. 0.5  1,*
|*   0.5 .. 1  3,*
|*   1 .. 2    4,*
|*   2 .. 4    1,*
|*   >= 4      1,*
|* Hausdorff   0.8* voxels from scene to voxels, 2,048 points, 0.8* from voxels to scene (to centres)
| ok: all judged voxels and triangles agree
$ svdag build a.ply -r 512 --rule thin -o thin.svdag -q
$ svdag-verify trace thin.svdag a.ply --rays 20K --seed 7 --json
|* {"command":"trace","file":"thin.svdag",*"rule":"thin",*"resolution":512,*"rays":20480,"both":*,"late":0,*"far":0,*"points_judged":0,"first":[[][]],*"points":2048,*"seed":7,"ok":true}

## verify_trace_little_memory
$ svdag-scene scan -n 50K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag-verify trace a.svdag a.ply -m 5M
! svdag-verify: the triangles for Embree need 6 MiB in total, but the memory budget is 5 MiB: raise --memory
? 5
$ svdag-verify trace a.svdag a.ply -m 8M
!* svdag-verify: the nodes of Embree's tree need * MiB in total, but the memory budget is 8 MiB: raise --memory
? 5

## verify_trace_no_rays
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag build a.ply -r 64 -o a.svdag -q
$ svdag-verify trace a.svdag a.ply --rays 0
! svdag-verify: --rays: give at least one
? 2

## verify_trace_other_scene
# A coarser mesh of the same surface: some triangles have no voxel, some voxels no
# triangle, and it extends beyond the grid. Exit code 1.
$ svdag-scene scan -n 5K -q -o a.ply
$ svdag-scene scan -n 2K -q -o b.ply
$ svdag build a.ply -r 256 -o a.svdag -q
$ svdag-verify trace a.svdag b.ply --rays 5K
|* grid        256^3 box, *
|* defect      the grid does not hold the scene: on x the scene reaches from *
|* defect      the grid does not hold the scene: on y the scene reaches from *
| judge       embree: its hits and distances, rechecked in double
| triangles   1,728
| in grid     1,728 triangles
|* rays        5,120, *
|...
|* late        5* triangle hits have no voxel at or before them, 2,* judged, *
|* far         1,7* voxels are too far from the scene, more than 0.8660 voxels, 3,* judged
|...
|*   late      ray * hits a triangle at (*, *, *), a voxel * voxels later
|...
| not ok: voxels and triangles differ; --seed 1 repeats it
? 1

## verify_trace_part_of_scene
# A file of one of two triangles is right for that one; the grid shows that the other is missing. A
# file restricted by --bounds is judged within them, and a mistyped pattern is reported.
$ printf 'v 0 0 0\nv 4 0 0\nv 0 4 1\nf 1 2 3\n' > one.obj
$ printf 'v 0 0 0\nv 4 0 0\nv 0 4 1\nf 1 2 3\nv 90 90 90\nv 94 90 90\nv 90 94 91\nf 4 5 6\n' > two.obj
$ svdag build one.obj -r 64 -o one.svdag -q
$ svdag build two.obj -r 64 --bounds=0,0,0,4,4,1 -o part.svdag -q
$ svdag-verify trace one.svdag two.obj --rays 1K > answer
? 1
$ grep '^defect\|^triangles\|^in grid\|^late\|^far\|^ok\|^not ok' answer | sed 's/: on .*//; s/ triangle hits .*//; s/ voxels are .*//'
| defect      the grid does not hold the scene
| defect      the grid does not hold the scene
| defect      the grid does not hold the scene
| triangles   2
| in grid     1 triangles
| late        0
| far         0
| not ok: voxels and triangles differ; --seed 1 repeats it
$ svdag-verify trace one.svdag two.obj --rays 1K --json | grep -o '"ok":[a-z]*\|"triangles[a-z_]*":[0-9]*'
| "triangles":2
| "triangles_in_grid":1
| "ok":false
$ svdag-verify trace part.svdag two.obj --rays 1K --exclude 'sky*' --allow-empty > answer
$ grep '^defect\|^triangles\|^unmatched\|^in grid\|^outside\|^ok' answer | sed 's/ voxels are .*//'
| triangles   2
| unmatched   --exclude 'sky*'
| in grid     1 triangles
| outside     0
| ok: all judged voxels and triangles agree

## verify_trace_point
# Rays need a direction even around a scene that is a single point. The thin file has no voxel, so
# nothing is judged: the result is not "ok".
$ printf 'v 5 5 5\nv 5 5 5\nv 5 5 5\nf 1 2 3\n' > point.obj
$ for rule in thin conservative; do
>   svdag build point.obj -s 1 --rule $rule -o point.svdag -q
>   svdag-verify trace point.svdag point.obj --rays 100 > answer || echo "exit $?"
>   grep '^ok\|^not ok' answer || true
> done
| exit 2
| ok: all judged voxels and triangles agree
! svdag-verify: --rays: nothing was judged: no ray hit a triangle that must have a voxel, and the file has no voxel: give more rays, or compare every voxel with svdag-verify mesh

## verify_trace_segments
# Rays miss triangles of zero area; points on the surface show that a file lacks their voxels.
# The thin rule sets no voxel for them, so nothing is judged: the result is not "ok".
$ printf 'v 0 0 0\nv 1 2 3\nv 2 1 0\nf 1 2 2\nf 2 3 3\nf 3 1 1\n' > segments.obj
$ printf 'v 9 9 9\nv 8 9 9\nv 9 8 9\nf 1 2 3\n' > elsewhere.obj
$ bounds=--bounds=-1,-1,-1,4,4,4
$ for rule in conservative thin; do
>   svdag build segments.obj -r 64 $bounds --rule $rule -o segments.svdag -q
>   svdag build elsewhere.obj -r 64 $bounds --rule $rule -o empty.svdag -q
>   for file in segments empty; do
>     echo "$rule, $file"
>     svdag-verify trace $file.svdag segments.obj --rays 10K > answer || echo "exit code $?"
>     grep "^late\|^uncovered\|^ok\|^not ok" answer || continue  # nothing was judged
>     grep "^  uncovered" answer | head -1 | sed 's/(.*)/(...)/'
>   done
> done
| conservative, segments
| late        0 triangle hits have no voxel at or before them, 0 judged, 0 doubtful, within 3.4e-11 voxels of an edge
| uncovered   0 points of the surface are more than 0.8660 voxels from a voxel, 1,024 judged
| ok: all judged voxels and triangles agree
| conservative, empty
| exit code 1
| late         0 triangle hits have no voxel at or before them, 0 judged, 0 doubtful, within 3.4e-11 voxels of an edge
| uncovered    1,024 points of the surface are more than 0.8660 voxels from a voxel, 1,024 judged
| not ok: voxels and triangles differ; --seed 1 repeats it
|   uncovered  point at (...) of the surface has no voxel anywhere
| thin, segments
| exit code 2
| thin, empty
| exit code 2
! svdag-verify: --rays: nothing was judged: no ray hit a triangle that must have a voxel, and the file has no voxel: give more rays, or compare every voxel with svdag-verify mesh
! svdag-verify: --rays: nothing was judged: no ray hit a triangle that must have a voxel, and the file has no voxel: give more rays, or compare every voxel with svdag-verify mesh
$ svdag build segments.obj -r 64 $bounds -o segments.svdag -q
$ svdag-verify trace segments.svdag segments.obj --rays 1 --json | grep -o '"points":[0-9]*'
| "points":1
