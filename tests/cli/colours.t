# Colours of files: what shows them, what keeps them, what leaves them out.

## colours
# svdag info, check and convert know the colours; the geometry keeps its hash.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o plain.svdag -r 128
$ paint_dag plain.svdag painted.svdag 7 9
$ svdag info painted.svdag | tail -3
|   78,936 colours down to level 7, 7.3 KiB, 0.753 bits a colour, largest error 9
|   content hash 0873013f8bb4b1b4a2e41c9d61ca4d43
|   colour hash  572d6630feeef9842ae5f66525f83960
$ svdag info plain.svdag | tail -1
|   content hash 0873013f8bb4b1b4a2e41c9d61ca4d43
$ svdag info painted.svdag --json | grep -A7 '"colours"'
|   "colours": {
|     "level": 7,
|     "error": 9,
|     "count": 78936,
|     "bytes": 7432,
|     "bits_per_colour": 0.7532177966960576,
|     "hash": "572d6630feeef9842ae5f66525f83960"
|   },
$ svdag-verify check painted.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag convert painted.svdag -q -o bare.svdag --no-colours && cmp bare.svdag plain.svdag && echo "the bytes from before"
| the bytes from before
$ svdag convert painted.svdag -q -o compact.svdag --layout compact
$ svdag-verify check compact.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag convert compact.svdag -q -o back.svdag --layout plain && cmp back.svdag painted.svdag && echo "both layouts have the colours"
| both layouts have the colours
$ svdag convert compact.svdag -q -o bare.svdag --layout compact --no-colours && svdag convert plain.svdag -q -o small.svdag --layout compact && cmp bare.svdag small.svdag && echo "and lose them"
| and lose them
$ svdag-verify diff painted.svdag plain.svdag | tail -2
| colours   only A
| same
$ paint_dag plain.svdag other.svdag 6 9 && svdag-verify diff painted.svdag other.svdag | tail -2
| colours   stored differently
| same

## colours_query
# svdag query prints the colour of a set voxel: that of the cube of the colour level around it. Other lines are as without.
$ printf 'OFF\n3 1 0\n0 0 0\n10 0 0\n10 10 10\n3 0 1 2\n' > t.off && svdag build t.off -s 1 -q -o t.svdag && paint_dag t.svdag p.svdag 4 9
$ printf '5 0 0\n9 5 5\n0 10 0\n-99 9 9\n' | svdag query p.svdag
| set 5  4.5 -0.5 -0.5  5.5 0.5 0.5  #d3dfe7
| set 5  8.5 4.5 4.5  9.5 5.5 5.5  #c3499e
| empty 2  -7.5 8.5 -7.5  0.5 16.5 0.5
| outside
$ paint_dag p.svdag | grep '^5 24 20 20'
| 5 24 20 20 c3499e

## colours_kept
# Parts and coarser levels have the colours that their cubes had; packs have all.
$ svdag-scene city -n 2K -q -o city.ply && svdag-scene scan -n 2K -q -o scan.ply
$ svdag build city.ply scan.ply -q -o plain.svdag -r 128 --layers file
$ paint_dag plain.svdag painted.svdag 7 9
$ colours() { paint_dag $1 | grep "^$2 " | sort > $1.$2; }
$ colours painted.svdag 7 && colours painted.svdag 5
$ svdag edit painted.svdag -q -o coarse.svdag --level 6 && svdag convert painted.svdag -q -o coarse2.svdag --level 6 && cmp coarse.svdag coarse2.svdag
$ colours coarse.svdag 5 && cmp coarse.svdag.5 painted.svdag.5 && svdag info coarse.svdag | grep -o " down to level ."
|  down to level 5
$ svdag edit painted.svdag -q -o part.svdag --bounds=0,0,0,40,40,40 && colours part.svdag 7
$ comm -23 part.svdag.7 painted.svdag.7 && svdag info part.svdag | grep -o "[0-9,]* colours down to level ., .*iB"
| 13,225 colours down to level 7, 2.0 KiB
$ svdag-verify check part.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag edit painted.svdag -q -o small.svdag --bounds=0,0,0,40,40,40 --layout compact && colours small.svdag 7 && cmp small.svdag.7 part.svdag.7
$ svdag-verify check small.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag edit painted.svdag -q -o one.svdag --layer scan.ply && colours one.svdag 7 && comm -23 one.svdag.7 painted.svdag.7
$ svdag-verify check one.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag pack painted.svdag -q -o a.pack && svdag unpack a.pack -q -o unpacked.svdag && cmp unpacked.svdag painted.svdag
$ svdag-verify check a.pack | tail -1
| ok: sound, in canonical order and minimal
$ svdag pack painted.svdag -q -o part.pack --bounds=0,0,0,40,40,40 && svdag unpack part.pack -q -o again.svdag && cmp again.svdag part.svdag
$ svdag pack plain.svdag -q -o plain.pack && for f in a plain; do head -c 12 $f.pack | tail -c 4 | xxd -p; done
| 02000000
| 01000000

## colours_dropped
# Never silently.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o plain.svdag -r 128
$ paint_dag plain.svdag painted.svdag 7 9
$ svdag edit painted.svdag plain.svdag -q -o both.svdag --union
! svdag: painted.svdag: its colours are left out of the output
$ cmp both.svdag plain.svdag

## colours_shown
# Pictures are in the colours of the file.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o plain.svdag -r 128
$ paint_dag plain.svdag painted.svdag 7 9
$ svdag-verify render painted.svdag -o colour.png --size 64x64
| colour.png: 64x64, colour
$ svdag-verify render painted.svdag -q -o grey.png --size 64x64 --mode primary && svdag-verify render plain.svdag -q -o plain.png --size 64x64
$ cmp grey.png plain.png && echo "grey without"
| grey without
$ cmp -s grey.png colour.png || echo "other in colour"
| other in colour
$ svdag-verify render plain.svdag -o c.png --mode colour
! svdag-verify: --mode colour: plain.svdag has neither colours nor layers (svdag build --colours, --layers)
? 2
$ for f in painted plain; do svdag-trace $f.svdag --size 64x64 --samples 2 --rounds 1 --picture $f.ppm > /dev/null; done
$ cmp -s painted.ppm plain.ppm || echo "rays in colour, too"
| rays in colour, too
