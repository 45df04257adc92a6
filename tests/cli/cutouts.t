# Cut-outs: what an alpha mask makes transparent is no voxel.

## cut_outs
# Every way of baking gives the same bytes, and every voxel is judged by itself.
$ python3 -B $TESTS/cut_scene.py 1000
$ svdag build cut.glb -o a.svdag -r 256 | sed 's/, [0-9.]* s$//'
| a.svdag: 256^3, 4,500 triangles, 363,062 voxels, 35,130 nodes, 415.6 KiB (9.38 bits per voxel)
|   4,000 triangles are cut out by the alpha of their material
$ svdag-verify mesh a.svdag cut.glb | tail -4
| voxels     363,062 in the file, 363,062 by the judge
| missing    0
| extra      0
| ok: every voxel agrees with the scene
$ svdag build cut.glb -o b.svdag -r 256 -m 4M -v | grep -c scratch: && cmp a.svdag b.svdag
| 1
$ svdag plan cut.glb -o plan -r 256 --shards 2 -q && svdag run plan -q && cmp a.svdag plan/plan.svdag
$ for i in 1 2; do svdag build cut.glb -o $i.run -r 256 -q --part $i/2; done
$ svdag merge 1.run 2.run -o b.svdag -q && cmp a.svdag b.svdag
$ for i in 1 2; do svdag build cut.glb -o b.svdag -r 256 -q --cache cells && cmp a.svdag b.svdag; done
$ svdag build cut.glb -o t.svdag -r 256 --rule thin -q && svdag-verify mesh t.svdag cut.glb --judge cgal | tail -1
| ok: every voxel agrees with the scene

## cut_outs_of_layers
$ python3 -B $TESTS/cut_scene.py 50
$ svdag build cut.glb -o a.svdag -r 128 --layers material -q && svdag-verify mesh a.svdag cut.glb | tail -4
| missing    0
| extra      0
| layers     3 layers agree
| ok: every voxel agrees with the scene

## whole_by_choice
$ python3 -B $TESTS/cut_scene.py 20
$ svdag build cut.glb -o a.svdag -r 128 --no-cutouts | sed 's/, [0-9.]* s$//'
| a.svdag: 128^3, 90 triangles, 2,892 voxels, 631 nodes, 7.9 KiB (22.3 bits per voxel)
|   2 meshes of materials with transparent points are baked whole
$ svdag-verify mesh a.svdag cut.glb --no-cutouts | tail -1
| ok: every voxel agrees with the scene
$ svdag-verify mesh a.svdag cut.glb | tail -1
| not ok: file and scene differ
$ svdag info cut.glb | tail -1
|   80 triangles are cut out by the alpha of their material
$ svdag info cut.glb --parts | grep material:
|               40  material:noisy  (-10.0705233, -9.90596867, -10.0844316) .. (9.97916126, 9.89784241, 9.98605442), 40.6 % opaque
|               40  material:smooth  (-9.48893356, -7.79260635, -10.4189434) .. (9.59815598, 9.61961079, 9.86519432), 78.1 % opaque
|               10  material:whole  (-9.04554939, -9.98473454, -9.05269146) .. (5.01157236, 3.54701281, 0.35863772)
$ svdag info cut.glb --json | grep -E '"(cut|triangles)"'
|   "triangles": 90,
|   "cut": 80,

## cut_outs_by_name
# A pattern makes a mask of a material, in the same bytes.
$ python3 -B $TESTS/cut_scene.py 40 MASK && svdag build cut.glb -o mask.svdag -r 128 -q
$ python3 -B $TESTS/cut_scene.py 40 BLEND
$ svdag build cut.glb -o whole.svdag -r 128 --cache cells | tail -2
|   1 mesh of a material that blends is baked whole; --cutout PATTERN cuts out what is transparent
|   160 triangles are cut out by the alpha of their material
$ svdag build cut.glb -o a.svdag -r 128 --cache cells --cutout 'material:wh?le' | tail -1
|   180 triangles are cut out by the alpha of their material
$ cmp a.svdag mask.svdag; cmp -s whole.svdag mask.svdag || echo differ
| differ
$ svdag-verify mesh a.svdag cut.glb --cutout smooth --cutout 'wh*' | tail -1
| ok: every voxel agrees with the scene
$ svdag plan cut.glb -o plan -r 128 --shards 2 -q --cutout whole && svdag run plan -q && cmp a.svdag plan/plan.svdag
$ python3 -B $TESTS/cut_scene.py 40 OPAQUE && svdag build cut.glb -o b.svdag -r 128 -q --cutout whole && cmp a.svdag b.svdag
# Without the coordinates of its texture a mesh has none, and is whole.
$ python3 -B $TESTS/cut_scene.py 40 MASK TEXCOORD_1 && svdag build cut.glb -o b.svdag -r 128 -q && cmp whole.svdag b.svdag

## cut_outs_by_a_name_that_is_none
$ python3 -B $TESTS/cut_scene.py 20
$ svdag build cut.glb -o a.svdag -r 64 --cutout 'leaf*' --cutout smooth
! svdag: --cutout 'leaf*' matches no material of a glTF or OBJ file: the nearest names are material:noisy, material:whole, material:smooth (--allow-empty goes on)
? 2
$ svdag info cut.glb --cutout 'leaf*' --allow-empty | grep matches
|   no part of the scene matches --cutout 'leaf*'
$ svdag build cut.glb -o a.svdag -r 64 --cutout whole --no-cutouts
! svdag: --cutout: --no-cutouts bakes all materials whole: give one
? 2

## cut_outs_of_an_obj
# The same voxels as of the glTF scene, whose textures are upside down.
$ python3 -B $TESTS/cut_scene.py 40 MASK && svdag build cut.glb -o glb.svdag -r 128 -q --exclude smooth
$ svdag build cut.obj -o a.svdag -r 128 | tail -1
|   100 triangles are cut out by the alpha of their material
$ cmp a.svdag glb.svdag && svdag-verify mesh a.svdag cut.obj | tail -1
| ok: every voxel agrees with the scene
$ svdag plan cut.obj -o plan -r 128 --shards 2 -q && svdag run plan -q && cmp a.svdag plan/plan.svdag
$ svdag build cut.obj -o b.svdag -r 128 -q -m 4M && cmp a.svdag b.svdag
$ python3 -B $TESTS/cut_scene.py 40 && svdag build cut.obj -o b.svdag -r 128 -q --cutout whole && cmp a.svdag b.svdag
$ svdag build cut.obj -o noisy.png -r 16
! svdag: noisy.png is also an input, which is never overwritten: choose another output
? 2
$ rm noisy.png && svdag build cut.obj -o b.svdag -r 16
! svdag: noisy.png: cannot be opened: no such file or folder; --no-cutouts bakes the material whole
? 3
$ svdag build cut.obj -o b.svdag -r 16 -q --no-cutouts

## what_cannot_judge_cut_outs_says_so
$ python3 -B $TESTS/cut_scene.py 20
$ svdag build cut.glb -o a.svdag -r 64 -q
$ svdag-verify mesh a.svdag cut.glb --judge openvdb
! svdag-verify: the material "noisy" is cut out, which OpenVDB cannot judge: choose --judge integer or cgal (--no-cutouts judges a bake with it whole)
? 2
$ svdag build cut.glb -o b.svdag -r 64 --rule solid
! svdag: the material "noisy" has transparent points, so its surface bounds no solid (--no-cutouts bakes it whole)
? 2

## a_mask_that_cannot_be_read
# It decides voxels, so it is an error, with the way out.
$ python3 -B $TESTS/cut_scene.py 4
$ python3 -c "
> data = open('cut.glb', 'rb').read()
> open('broken.glb', 'wb').write(data.replace(b'\x89PNG', b'\x89PNX'))"
$ svdag build broken.glb -o a.svdag -r 64
! svdag: broken.glb: images[0]: is not a readable PNG or JPEG image: unknown image type; --no-cutouts bakes the material whole
? 3
$ svdag build broken.glb -o a.svdag -r 64 --no-cutouts -q

## rays_pass_through_cut_outs
# Judged with the material whole, triangles that were cut out have lost their voxels.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o a.svdag -r 128 -q
$ svdag-verify trace a.svdag cut.glb --rays 100000 | tail -1
| ok: all judged voxels and triangles agree
$ svdag-verify trace a.svdag cut.glb --rays 100000 --no-cutouts | tail -1
| not ok: voxels and triangles differ; --seed 1 repeats it
$ svdag build cut.glb -o c.svdag -r 128 -q --rule thin && svdag-verify trace c.svdag cut.glb --rays 100000 | tail -1
| ok: all judged voxels and triangles agree
