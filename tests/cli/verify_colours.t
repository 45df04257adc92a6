# svdag-verify colours.

## verify_colours
# The texture is cut out, and noise: much is allowed.
$ python3 -B $TESTS/cut_scene.py 300
$ svdag build cut.glb -o a.svdag -r 128 --colours --colour-error 0 -q
$ svdag-verify colours a.svdag cut.glb
$ svdag-verify colours a.svdag cut.glb --sample 100 --seed 7 --json
$ svdag build cut.glb -o b.svdag -r 128 --colours --no-cutouts -q
$ svdag-verify colours b.svdag cut.glb --no-cutouts -q

## verify_colours_of_another_scene
# One corner is blue instead of green, and every voxel of its triangle a little.
$ printf 'v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 0 1 0\nv 0 1 0 1 1 1\nf 1 2 3\nf 1 3 4\n' > green.obj
$ sed 's/0 1 0$/0 0 1/' green.obj > blue.obj
$ svdag build green.obj -o a.svdag -r 16 --colours --colour-error 0 -q
$ svdag-verify colours a.svdag green.obj
$ svdag-verify colours a.svdag blue.obj --sample 6
$ svdag-verify colours a.svdag blue.obj -q

## verify_colours_refused
$ printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n' > square.obj
$ head -5 square.obj > half.obj
$ svdag build square.obj -o plain.svdag -r 16 -q
$ svdag-verify colours plain.svdag square.obj
$ svdag colour plain.svdag square.obj -o a.svdag -q
$ svdag-verify colours a.svdag half.obj
$ svdag-verify colours a.svdag square.obj --sample 0
