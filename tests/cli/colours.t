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
$ svdag-verify diff painted.svdag plain.svdag -q && echo "the same voxels"
| the same voxels

## colours_dropped
# Never silently.
$ svdag-scene city -n 2K -q -o city.ply
$ svdag build city.ply -q -o plain.svdag -r 128
$ paint_dag plain.svdag painted.svdag 7 9
$ svdag edit painted.svdag -q -o coarse.svdag --level 5
! svdag: painted.svdag: its colours are left out of the output
$ svdag convert painted.svdag -q -o coarse2.svdag --level 5
! svdag: painted.svdag: its colours are left out of the output
$ cmp coarse.svdag coarse2.svdag
$ svdag pack painted.svdag -q -o a.pack
! svdag: painted.svdag: its colours are left out of the output
$ svdag unpack a.pack -q -o unpacked.svdag && cmp unpacked.svdag plain.svdag && echo "the bytes from before"
| the bytes from before

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
! svdag-verify: --mode colour: plain.svdag has neither colours nor layers (svdag build --layers)
? 2
$ for f in painted plain; do svdag-trace $f.svdag --size 64x64 --samples 2 --rounds 1 --picture $f.ppm > /dev/null; done
$ cmp -s painted.ppm plain.ppm || echo "rays in colour, too"
| rays in colour, too
