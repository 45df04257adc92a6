# svdag-verify mesh.

## verify_mesh_all
$ svdag-scene scan -n 5K -q -o scan.ply
$ svdag build scan.ply -r 128 -o scan.svdag -q
$ svdag-verify mesh scan.svdag scan.ply
| grid       128^3 box, voxel size 0.8467508150836615, corner (-42.66660050519808, -48.589223185862146, -45.53757218488558), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  4,800
| bricks     3,471 (all), 0 wrong
| voxels     58,049 in the file, 58,049 by the judge
| missing    0
| extra      0
| ok: every voxel agrees with the scene

## verify_mesh_little_memory
$ svdag-scene scan -n 50K -q -o scan.ply
$ svdag build scan.ply -r 64 -o scan.svdag -q
$ svdag-verify mesh scan.svdag scan.ply --memory 2M
! svdag-verify: the snapped triangles need 4 MiB in total, but the memory budget is 2 MiB: raise --memory
? 5

## verify_mesh_openvdb
# Both rules are within the bounds of OpenVDB's distances; the file of another scene is not.
$ svdag-scene city -n 3K -q -o a.ply
$ svdag-scene city -n 3K --seed 5 -q -o b.ply
$ svdag build a.ply -r 256 -o a.svdag -q
$ svdag build a.ply -r 256 --rule thin -o thin.svdag -q
$ svdag-verify mesh a.svdag a.ply --judge openvdb
| grid       256^3 box, voxel size 0.3764705882352941, corner (-48.188235294117646, -1.188235294117647, -48.188235294117646), rule conservative, matches the scene's bounds
| judge      openvdb: distances of its mesh-to-volume, {d <= 1/2} in file in {d <= sqrt(3)/2}
| triangles  3,000
| windows    1 (all), 16,777,216 voxels tested
| voxels     328,308 in the file, 325,665 with d <= 1/2
| missing    0
| extra      0
| exact      0 on a bound within the error of a float, decided in integers
| ok: every voxel tested is between the bounds
$ svdag-verify mesh thin.svdag a.ply --judge openvdb
| grid       256^3 box, voxel size 0.3764705882352941, corner (-48.188235294117646, -1.188235294117647, -48.188235294117646), rule thin, matches the scene's bounds
| judge      openvdb: distances of its mesh-to-volume, file in {d <= 1/2}
| triangles  3,000
| windows    1 (all), 16,777,216 voxels tested
| voxels     316,256 in the file, 325,665 with d <= 1/2
| missing    0
| extra      0
| exact      0 on a bound within the error of a float, decided in integers
| ok: every voxel tested is between the bounds
$ svdag build a.ply -r 8K -o large.svdag -q
$ svdag-verify mesh large.svdag a.ply --judge openvdb --sample 3 --json
| {"command":"mesh","file":"large.svdag","content_hash":"f8257f5312db940833ef174de0d6cd4b","rule":"conservative","grid_recomputed":true,"bounded":false,"selection":[0,0,0,8192,8192,8192],"grid_defects":[],"triangles":3000,"invalid_triangles":0,"patterns_unmatched":[],"judge":"openvdb","sampled":true,"windows":3,"tested":402653184,"file_voxels":3500034,"inner":3500034,"missing":0,"extra":0,"first_wrong":[],"decided_exactly":0,"openvdb_errors":0,"ok":true}
$ svdag-verify mesh a.svdag b.ply --judge openvdb | grep -v "^  "
| grid       256^3 box, voxel size 0.3764705882352941, corner (-48.188235294117646, -1.188235294117647, -48.188235294117646), rule conservative, matches the scene's bounds
| judge      openvdb: distances of its mesh-to-volume, {d <= 1/2} in file in {d <= sqrt(3)/2}
| triangles  3,000
| windows    1 (all), 16,777,216 voxels tested
| voxels     328,308 in the file, 318,345 with d <= 1/2
| missing    114,089
| extra      108,563
| exact      0 on a bound within the error of a float, decided in integers
| not ok: file and scene differ
$ svdag-verify mesh a.svdag b.ply --judge openvdb -q
? 1

## verify_mesh_other_scene
# A file that was baked from another scene differs: exit code 1.
$ svdag-scene city -n 1.2K --seed 1 -q -o one.ply
$ svdag-scene city -n 1.2K --seed 2 -q -o two.ply
$ svdag build one.ply -r 64 -o one.svdag -q
$ svdag-verify mesh one.svdag two.ply
| grid       64^3 box, voxel size 1.5238095238095237, corner (-48.76190476190476, -1.7619047619047619, -48.76190476190476), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  1,200
| bricks     732 (all), 673 wrong
| voxels     17,465 in the file, 15,721 by the judge
| missing    3,873
| extra      5,617
|   missing  voxel (1, 5, 1) at (-46.4761905, 6.61904762, -46.4761905)
|   missing  voxel (1, 5, 2) at (-46.4761905, 6.61904762, -44.952381)
|   missing  voxel (1, 5, 3) at (-46.4761905, 6.61904762, -43.4285714)
|   missing  voxel (1, 6, 1) at (-46.4761905, 8.14285714, -46.4761905)
|   missing  voxel (1, 6, 2) at (-46.4761905, 8.14285714, -44.952381)
|   missing  voxel (1, 6, 3) at (-46.4761905, 8.14285714, -43.4285714)
|   missing  voxel (2, 5, 1) at (-44.952381, 6.61904762, -46.4761905)
|   missing  voxel (3, 5, 1) at (-43.4285714, 6.61904762, -46.4761905)
| not ok: file and scene differ
? 1

## verify_mesh_sample
# A sample finds missing voxels even of triangles without area, and gives bounds only for uniform draws.
$ awk 'BEGIN {
>   for (i = 0; i < 3000; ++i) {
>     x = 2 + i % 50 / 1000; y = 2 + i / 60000; n = 3 * i
>     print "v", x, y, 2; print "v", x, y, 2.0001; print "v", x + 0.0001, y, 2
>     print "o dots"; print "f", n + 1, n + 2, n + 3
>   }
>   print "v 0 0 0"; print "v 4 0.1 4"; print "f 9001 9001 9001"; print "f 9002 9002 9002"
>   print "o needle"; print "v 0 0.013 0"; print "v 4 0.013 4"; print "f 9003 9004 9004"
> }' > scene.obj
$ svdag build scene.obj -s 0.004 -o all.svdag -q
$ svdag build scene.obj -s 0.004 --exclude needle -o dots.svdag -q
$ svdag-verify mesh all.svdag scene.obj --sample 1000
| grid       2K^3 lattice, voxel size 0.004, corner (-4.094, -4.094, -4.094), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  3,003
| bricks     440 sampled, 0 wrong
| voxels     2,153 in the file, 2,153 by the judge
| missing    0
| extra      0
| drawn      500 bricks of the file, 0 wrong, so at most 0.597 % of its bricks
| drawn      167 points by area, 0 in wrong bricks, so at most 1.78 % of the area
| drawn      167 points by longest edge, 0 in wrong bricks, so at most 1.78 % of that length
| drawn      166 points beside triangles, 0 in wrong bricks
| bounds     each at 95 % confidence; the number of missing bricks is not bounded
| ok: no sampled voxel differs
$ svdag-verify mesh dots.svdag scene.obj --sample 1000 | grep -v "^  missing"
| grid       2K^3 lattice, voxel size 0.004, corner (-4.094, -4.094, -4.094), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  3,003
| bricks     141 sampled, 108 wrong
| voxels     171 in the file, 1,251 by the judge
| missing    1,080
| extra      0
| drawn      500 bricks of the file, 0 wrong, so at most 0.597 % of its bricks
| drawn      167 points by area, 0 in wrong bricks, so at most 1.78 % of the area
| drawn      167 points by longest edge, 158 in wrong bricks, so at most 97.2 % of that length
| drawn      166 points beside triangles, 0 in wrong bricks
| bounds     each at 95 % confidence; the number of missing bricks is not bounded
| not ok: file and scene differ
$ svdag-verify mesh dots.svdag scene.obj --sample 100 -q
? 1
$ svdag-verify mesh all.svdag scene.obj --sample 6 --json
| {"command":"mesh","file":"all.svdag","content_hash":"bab50f34ab6d00034fe49f0debdc1a50","rule":"conservative","grid_recomputed":true,"bounded":false,"selection":[0,0,0,2048,2048,2048],"grid_defects":[],"triangles":3003,"invalid_triangles":0,"patterns_unmatched":[],"judge":"integer","sampled":true,"bricks":6,"wrong_bricks":0,"file_voxels":33,"judge_voxels":33,"missing":0,"extra":0,"first_wrong":[],"sample":{"file_bricks":{"draws":3,"wrong":0,"wrong_file_bricks_bound_95":0.6315968501359612},"scene_area":{"draws":1,"wrong":0,"area_in_wrong_bricks_bound_95":0.95},"scene_longest_edges":{"draws":1,"wrong":0,"length_in_wrong_bricks_bound_95":0.95},"beside_triangles":{"draws":1,"wrong":0}},"ok":true}

## verify_mesh_sample_nothing
# A sample of an empty file draws from the scene; if that is empty too, the result is not "ok".
$ printf 'v 0 0 0\nv 0 8 8\nv 8 0 8\nf 1 2 3\n' > scene.obj
$ printf 'v 0 0 0\nv 0 2 2\nv 2 0 2\nf 1 2 3\nv 0 0 9\n' > small.obj
# Inside the triangle's box, and beside the triangle.
$ svdag build scene.obj -s 0.125 --bounds=0,0,5,0.5,0.5,5.5 -o empty.svdag -q
$ svdag-verify mesh empty.svdag scene.obj | tail -1
| ok: every voxel agrees with the scene
$ svdag-verify mesh empty.svdag scene.obj --sample 10
! svdag-verify: --sample: no brick to draw: the file has no voxels, and no triangle was found in its grid: omit --sample to compare all bricks
? 2
$ svdag-verify mesh empty.svdag scene.obj --sample 10 --judge openvdb
! svdag-verify: --sample: no brick to draw: the file has no voxels, and no triangle was found in its grid: omit --sample to compare all bricks
? 2
$ svdag-verify mesh empty.svdag small.obj --sample 10 | tail -1
| ok: the file has no voxel, and no triangle meets its selection
$ svdag-verify mesh empty.svdag small.obj --sample 10 --judge openvdb | tail -1
| ok: the file has no voxel, and no triangle meets its selection
# One draw is enough for a file that lacks every voxel.
$ printf 'v 0 0 5\nv 0.5 0 5\nv 0.5 0.5 5.5\nf 1 2 3\n' > there.obj
$ svdag-verify mesh empty.svdag there.obj --sample 1 -q
? 1
$ svdag-verify mesh empty.svdag there.obj --sample 1 --judge openvdb -q
? 1

## verify_mesh_thin
$ svdag-scene scan -n 1K -q -o scan.ply
$ svdag build scan.ply -r 64 --rule thin -o scan.svdag -q
$ svdag-verify mesh scan.svdag scan.ply --judge integer
| grid       64^3 box, voxel size 1.7387971423921131, corner (-42.89645240420387, -50.11912391299293, -46.33889625186012), rule thin, matches the scene's bounds
| judge      integer: exact lines of centres
| triangles  972
| bricks     665 (all), 0 wrong
| voxels     7,095 in the file, 7,095 by the judge
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag-verify mesh scan.svdag scan.ply --judge cgal
| grid       64^3 box, voxel size 1.7387971423921131, corner (-42.89645240420387, -50.11912391299293, -46.33889625186012), rule thin, matches the scene's bounds
| judge      cgal: CGAL's exact kernel
| triangles  972
| bricks     665 (all), 0 wrong
| voxels     7,095 in the file, 7,095 by the judge
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag-verify mesh scan.svdag scan.ply --judge cgal --sample 100 --json --memory 64M
| {"command":"mesh","file":"scan.svdag","content_hash":"55b85ed665a97273086562a65ea38fb0","rule":"thin","grid_recomputed":true,"bounded":false,"selection":[0,0,0,64,64,64],"grid_defects":[],"triangles":972,"invalid_triangles":0,"patterns_unmatched":[],"judge":"cgal","sampled":true,"bricks":95,"wrong_bricks":0,"file_voxels":1095,"judge_voxels":1095,"missing":0,"extra":0,"first_wrong":[],"sample":{"file_bricks":{"draws":50,"wrong":0,"wrong_file_bricks_bound_95":0.05815507911697225},"scene_area":{"draws":17,"wrong":0,"area_in_wrong_bricks_bound_95":0.16156611126074005},"scene_longest_edges":{"draws":17,"wrong":0,"length_in_wrong_bricks_bound_95":0.16156611126074005},"beside_triangles":{"draws":16,"wrong":0}},"ok":true}

## verify_mesh_unmatched
# A pattern that matches no part is reported: a mistyped name would verify against another scene.
$ svdag-scene scan -n 5K -q -o scan.ply
$ svdag build scan.ply -r 128 -o scan.svdag -q
$ svdag-verify mesh scan.svdag scan.ply --exclude 'sky*' --allow-empty
| grid       128^3 box, voxel size 0.8467508150836615, corner (-42.66660050519808, -48.589223185862146, -45.53757218488558), rule conservative, matches the scene's bounds
| judge      integer: exact clipping
| triangles  4,800
| unmatched  --exclude 'sky*'
| bricks     3,471 (all), 0 wrong
| voxels     58,049 in the file, 58,049 by the judge
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag-verify mesh scan.svdag scan.ply --exclude 'sky*' --allow-empty --json
| {"command":"mesh","file":"scan.svdag","content_hash":"07a2c65e7cf1d8a33f30cc17e872a5f0","rule":"conservative","grid_recomputed":true,"bounded":false,"selection":[0,0,0,128,128,128],"grid_defects":[],"triangles":4800,"invalid_triangles":0,"patterns_unmatched":["--exclude 'sky*'"],"judge":"integer","sampled":false,"bricks":3471,"wrong_bricks":0,"file_voxels":58049,"judge_voxels":58049,"missing":0,"extra":0,"first_wrong":[],"ok":true}
