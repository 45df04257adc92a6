# Layers: build, edit, import and export them.

## chosen_layers
# --layer, given more than once: the file of these layers, whose union is theirs.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\nv 0 0 8\nf 4 3 5\no floor\nf 1 2 3\no wall\nf 1 4 5\no roof\nf 3 4 5\nf 2 4 5\n' > a.obj
$ svdag build a.obj -o a.svdag -r 256 --layers object -q
$ svdag info a.svdag --layers | tail -4
|               98,686             19              1  #bcb5aa  (unnamed)
|               33,151             19              5  #aef2bf  floor
|              196,350             47             10  #d96c95  roof
|               98,941             43              9  #9e804f  wall
$ svdag convert a.svdag -o two.svdag --layer wall --layer floor --layer wall
| two.svdag: plain, 3.3 KiB, 54.1 % of a.svdag
|   content hash d41868a24350d68274e680dcb92427a3
$ svdag-verify check two.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag info two.svdag --layers | tail -2
|               33,151             19              4  #aef2bf  floor
|               98,941             43              4  #9e804f  wall
# The union is the OR.
$ for layer in wall floor; do svdag convert a.svdag -q -o $layer.svdag --layer $layer; done
$ svdag edit wall.svdag floor.svdag --union -q -o edited.svdag && cmp two.svdag edited.svdag && echo "the union is the OR"
| the union is the OR
# One layer keeps its name and colour.
$ svdag info wall.svdag --layers | tail -1
|               98,941             43              0  #9e804f  wall
# One name, twice, is that layer alone. All names are the whole file.
$ svdag convert a.svdag -q -o again.svdag --layer wall --layer wall && cmp wall.svdag again.svdag
$ svdag convert a.svdag -q -o all.svdag --layer roof --layer floor --layer wall --layer '(unnamed)' && cmp a.svdag all.svdag
# Patterns, and all but what they match. A name wins: "(unnamed)" is no pattern.
$ svdag convert a.svdag -q -o x.svdag --layer '[fw]*' && cmp x.svdag two.svdag
$ svdag convert a.svdag -q -o x.svdag --layer '*' --layer '!(unnamed)' --layer '!r*f' && cmp x.svdag two.svdag
$ svdag convert a.svdag -q -o x.svdag --layer '!(unnamed)' --layer '!roof' && cmp x.svdag two.svdag
$ svdag convert a.svdag -q -o x.svdag --layer '!*'
! svdag: --layer: the patterns exclude every layer
? 2
$ svdag convert a.svdag -q -o x.svdag --layer '!glass*'
! svdag: --layer: the file has no layer "glass*" (svdag info --layers lists them)
? 2
# Every form of a file, and the other programs.
$ svdag convert a.svdag -q -o compact.svdag --layout compact && svdag pack a.svdag -q -o a.pack
$ for file in compact.svdag a.pack; do svdag convert $file -q -o x.svdag --layer floor --layer wall && cmp x.svdag two.svdag; done
$ svdag convert a.svdag -q -o x.svdag --layer floor --layer wall --layout compact && svdag convert x.svdag -q -o y.svdag --layout plain && cmp y.svdag two.svdag
$ svdag export a.svdag -q -o x.npz --layer floor --layer wall && svdag export two.svdag -q -o y.npz && cmp x.npz y.npz
$ svdag export a.svdag --layer floor --layer wall --format hashdag -o x.basic_dag.dag.bin -q
$ svdag export edited.svdag --format hashdag -o y.basic_dag.dag.bin -q && cmp x.basic_dag.dag.bin y.basic_dag.dag.bin
$ svdag-verify render a.svdag -o x.png --layer wall --layer floor --size 64x36
| x.png: 64x36, colour
$ svdag-verify render two.svdag -o y.png -q --size 64x36 && cmp x.png y.png
$ svdag-verify diff a.svdag two.svdag --layer wall --layer floor | tail -4
| only B    0
| layers    2 layers agree
| clusters  0
| same
# The unnamed layer has the name that is shown, unless a layer has that very name.
$ svdag pack a.svdag -q -o x.pack --layer wall && svdag unpack x.pack -q -o x.svdag && cmp x.svdag wall.svdag
$ svdag convert a.svdag -q -o unnamed.svdag --layer '(unnamed)' && svdag-verify check unnamed.svdag | sed -n 4p
| voxels  98,686
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 0 0 1\nf 1 2 3\no (unnamed)\nf 1 2 4\n' > b.obj
$ svdag build b.obj -o b.svdag -r 64 --layers object -q && svdag info b.svdag --layers | tail -2
|                2,143             13              2  #bcb5aa  (unnamed)
|                  320             20             15  #6cd9a3  (unnamed)
$ svdag export b.svdag -o b.npz --layer '(unnamed)'
| b.npz: npz, 320 voxels of level 6 (64^3)
# Errors.
$ svdag convert a.svdag -o x.svdag --layer wall --layer flor
! svdag: --layer: the file has no layer "flor"; did you mean "floor"? (svdag info --layers lists them)
? 2
$ svdag convert a.svdag -o x.svdag --layer '(unamed)'
! svdag: --layer: the file has no layer "(unamed)"; did you mean "(unnamed)"? (svdag info --layers lists them)
? 2
$ svdag convert a.svdag -o x.svdag --layer wall floor
! svdag: unexpected argument: floor; see svdag convert --help
? 2
$ svdag convert edited.svdag -o x.svdag --layer '(unnamed)' --layer wall
! svdag: --layer: the file has no layer "(unnamed)" (svdag info --layers lists them)
? 2

## edit_layers
# Edits keep layers: a crop is the bake with --bounds, set operations go by name, a file without layers is a mask.
$ svdag-scene atrium -q -o atrium.obj
$ cube='--cube=-17,-2,-10,34'
$ box='--bounds=-17,-2,-10,0.5,6,9'
$ svdag build atrium.obj -o a.svdag -r 128 $cube --layers material -q
$ svdag build atrium.obj -o baked.svdag -r 128 $cube --layers material -q $box
$ svdag edit a.svdag -o half.svdag $box
| half.svdag: 128^3, 27,012 voxels, 9 layers, 981 nodes, 14.4 KiB
|   content hash 78d6ec38eb6483a6f777c05ac31d9559
$ svdag info half.svdag --layers | tail -9 >half.txt
$ svdag info baked.svdag --layers | tail -9 | cmp - half.txt && svdag-verify diff half.svdag baked.svdag -q && echo "the crop is the bake"
| the crop is the bake
$ svdag edit a.svdag half.svdag -o rest.svdag --difference
| rest.svdag: 128^3, 54,757 voxels, 9 layers, 2,173 nodes, 32.4 KiB
|   content hash a9207650f760ebefd36c386457e97745
$ svdag edit rest.svdag half.svdag -o again.svdag --union -q && cmp again.svdag a.svdag && echo "both parts are all"
| both parts are all
$ svdag edit again.svdag -o coarse.svdag --level 5 --layout compact && svdag info coarse.svdag --layers | tail -9
| coarse.svdag: 32^3, 3,359 voxels, 9 layers, 396 nodes, 4.8 KiB
|   content hash 408c21cf120a1a6bcc35d32921d46571
|                  123             26             25  #294d9e  blue cloth
|                  510             23             20  #948c85  floor
|                   97             25             23  #428533  leaves
|                1,258             46             46  #db9e6b  plaster
|                  158             35             32  #b32129  red cloth
|                  566             40             29  #b85238  roof
|                1,388             75             73  #ccbd9e  stone
|                  216             12              9  #b3a899  tile
|                   57             25             25  #a8663d  vase
# Masks.
$ svdag build atrium.obj -o mask.svdag -r 128 $cube -q
$ svdag edit mask.svdag -o half_mask.svdag $box -q
$ svdag edit a.svdag half_mask.svdag -o b.svdag --intersection -q && svdag-verify diff b.svdag half.svdag -q && echo "the mask cuts every layer"
| the mask cuts every layer
$ svdag edit a.svdag half_mask.svdag -o b.svdag --difference -q && svdag-verify diff b.svdag rest.svdag -q && echo "and takes from every layer"
| and takes from every layer
$ svdag edit half_mask.svdag a.svdag -o b.svdag --intersection -q && cmp b.svdag half.svdag
$ svdag edit half_mask.svdag half.svdag -o b.svdag --difference
| b.svdag: 128^3, 0 voxels, 0 nodes, 1.3 KiB
|   content hash bf0cb0e4199f9a0b5e8e87921f659309
$ svdag edit half.svdag mask.svdag -o b.svdag --union && svdag info b.svdag --layers | grep unnamed
| b.svdag: 128^3, 81,769 voxels, 10 layers, 2,019 nodes, 29.3 KiB
|   content hash 0af11772e0ef6cb4ac8b5c46fbb5a842
|               81,769          1,469              0  #bcb5aa  (unnamed)
# One layer.
$ svdag edit a.svdag half.svdag -o b.svdag --difference --layer roof
| b.svdag: 128^3, 8,095 voxels, 1 layer, 339 nodes, 6.2 KiB
|   content hash 77922411067a5f408d24acd788052d67
$ svdag edit rest.svdag -o c.svdag --layer roof -q && svdag-verify diff b.svdag c.svdag -q
$ for f in half rest again coarse b; do svdag-verify check $f.svdag | tail -1; done
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
# Errors.
$ svdag build atrium.obj -o objects.svdag -r 128 $cube --layers object -q
$ svdag edit a.svdag objects.svdag -o x.svdag --union
! svdag: a.svdag and objects.svdag differ in what a layer is: material and object
? 2
$ svdag build atrium.obj -o frames.svdag -r 128 $cube --layers material --no-union -q
$ svdag edit mask.svdag frames.svdag -o x.svdag --difference
! svdag: frames.svdag: has no union of its layers to subtract: choose one with --layer
? 2
$ svdag edit mask.svdag half_mask.svdag -o x.svdag --union --layer roof
! svdag: --layer: the file has no layers
? 2
$ svdag edit a.svdag half.svdag -o x.svdag --union --layer rof
! svdag: --layer: the file has no layer "rof"; did you mean "roof"? (svdag info --layers lists them)
? 2

## export_colours
# --colours writes the colours of layers beside a HashDAG; both files or none.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\no one\nf 1 2 3\no two\nf 2 3 4\n' > a.obj
$ svdag build a.obj -o a.svdag -r 1K --layers object -q
$ svdag build a.obj -o plain.svdag -r 1K -q
$ svdag build a.obj -o empty.svdag -r 64 --layers object -q --bounds=900,900,900,901,901,901
$ svdag export a.svdag --format hashdag -o a --colours
| a1k.basic_dag.dag.bin: hashdag, 2,097,151 voxels of level 10 (1K^3)
$ svdag export a.svdag --format hashdag -o b -q
$ ls
| a.obj
| a.svdag
| a1k.basic_dag.dag.bin
| a1k.basic_dag.uncompressed_colors.bin
| b1k.basic_dag.dag.bin
| empty.svdag
| plain.svdag
$ svdag export a.svdag --format hashdag -o a --colours -n
! svdag: a1k.basic_dag.dag.bin: already exists: choose another name, or omit --no-clobber
? 2
$ rm a1k.basic_dag.dag.bin
$ svdag export a.svdag --format hashdag -o a --colours -n
! svdag: a1k.basic_dag.uncompressed_colors.bin: already exists: choose another name, or omit --no-clobber
? 2
$ svdag export plain.svdag --format hashdag -o c --colours
! svdag: --colours: plain.svdag has neither colours nor layers (svdag build --colours, --layers)
? 2
$ svdag export a.svdag --format hashdag -o c --colours --layer one
| c1k.basic_dag.dag.bin: hashdag, 525,823 voxels of level 10 (1K^3)
$ svdag export empty.svdag --format hashdag -o c.basic_dag.dag.bin --colours
! svdag: --colours: there is no voxel to colour
? 2
$ svdag export a.svdag -o c.npz --colours
! svdag: --colours: only hashdag has a second file of colours, the format is npz
? 2
# A limit on the file size simulates a full disk.
$ echo old > d1k.basic_dag.dag.bin
$ ulimit -f 64
$ svdag export a.svdag --format hashdag -o d --colours
! svdag: d1k.basic_dag.uncompressed_colors.bin: cannot be written: the file exceeds the size limit (ulimit -f)
? 4
$ cat d1k.basic_dag.dag.bin
| old
$ ls
| a.obj
| a.svdag
| a1k.basic_dag.uncompressed_colors.bin
| b1k.basic_dag.dag.bin
| c1k.basic_dag.dag.bin
| c1k.basic_dag.uncompressed_colors.bin
| d1k.basic_dag.dag.bin
| empty.svdag
| plain.svdag

## import_layers
# Labels of an .npz and colours of a .vox become layers.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nf 1 2 3\n' > floor.obj
$ printf 'v 0 0 4\nv 8 8 4\nv 0 0 8\nf 1 2 3\n' > wall.obj
$ svdag build floor.obj wall.obj -q -o a.svdag -r 64 --layers file && svdag info a.svdag --layers | tail -2
|                2,143             13              4  #6c7ad9  floor.obj
|                3,294             38              4  #6cd9d9  wall.obj
$ for format in npz vox; do
>   svdag export a.svdag -q -o a.$format
>   svdag import a.$format -o $format.svdag -r 64
>   svdag-verify check $format.svdag | tail -1
>   svdag info $format.svdag --layers | tail -2
>   svdag import a.$format -o plain.svdag -r 64 --no-layers
>   svdag-verify diff plain.svdag $format.svdag -q
> done
| npz.svdag: npz, 5,437 voxels of 64^3, 2 layers, 56 DAG nodes, 2.6 KiB
|   content hash 7500558d80d05eacb16ca92975a3910e
| ok: sound, in canonical order and minimal
|                2,143             13              4  #6c7ad9  floor.obj
|                3,294             38              4  #6cd9d9  wall.obj
| plain.svdag: npz, 5,437 voxels of 64^3, 48 DAG nodes, 2.3 KiB
|   content hash 5afe89eda2043635c1ac1a40dc7a20c3
| vox.svdag: vox, 5,437 voxels of 64^3, 2 layers, colours, 56 DAG nodes, 2.8 KiB
|   content hash 5b7c418be3a56738aa962719ee52c8bd
| ok: sound, in canonical order and minimal
|                2,143             13              4  #6c7ad9  colour-001
|                3,294             38              4  #6cd9d9  colour-002
| plain.svdag: vox, 5,437 voxels of 64^3, colours, 48 DAG nodes, 2.4 KiB
|   content hash 07944099c16da5972cebd0c4e1865bd5
$ svdag-verify diff npz.svdag a.svdag --layer floor.obj -q
$ svdag import a.npz -o json.svdag --json | grep layers
|   "layers": 2,
# Other formats have no layers.
$ svdag export a.svdag -q -o a.binvox && svdag import a.binvox -o b.svdag
| b.svdag: binvox, 5,437 voxels of 64^3, 48 DAG nodes, 2.3 KiB
|   content hash 5afe89eda2043635c1ac1a40dc7a20c3
# Wrong arrays: one message each.
$ cat > wrong.py <<'EOP'
> import io
> import sys
> import zipfile
>
> import numpy
>
> arrays = {"coordinates": numpy.array([[0, 0, 0], [1, 2, 3]]), "label": numpy.array([0, 1], "<u2"), "layer_names": b"a\0b\0"}
> arrays.update({name: eval(value) for name, value in (argument.split("=") for argument in sys.argv[1:])})
> with zipfile.ZipFile("wrong.npz", "w") as archive:
>     for name, array in arrays.items():
>         data = io.BytesIO()
>         numpy.save(data, numpy.frombuffer(array, "u1") if isinstance(array, bytes) else array)
>         archive.writestr(name + ".npy", data.getvalue())
> EOP
$ for change in "label=numpy.array([0,2])" "label=numpy.array([0])" "label=numpy.array([0.,1.])" "layer_names=b'a'" "layer_names=b'a\0a\0'" \
>   "layer_names=numpy.array([1.,2.])" "layer_colours=numpy.array([1])" "layer_colours=numpy.array([1,1<<24])" "layer_kind=b'thing\0'"; do
>   /usr/bin/python3 -B wrong.py "$change"
>   svdag import wrong.npz -o x.svdag || echo "exit $?"
> done
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
| exit 3
! svdag: wrong.npz: label 2 is not the number of one of the 2 layers (at byte 396)
! svdag: wrong.npz: has an array "label" that is not an integer for each row of "coordinates" (--no-layers ignores it)
! svdag: wrong.npz: has an array "label" that is not an integer for each row of "coordinates" (--no-layers ignores it)
! svdag: wrong.npz: has an array "layer_names" that does not end with a zero byte
! svdag: wrong.npz: two layers are named a (--no-layers ignores them)
! svdag: wrong.npz: has an array "layer_names" that is not a row of texts, or of uint8, of at most 64 MiB
! svdag: wrong.npz: has an array "layer_colours" that is not an integer for each layer
! svdag: wrong.npz: has an array "layer_colours" that is not of colours 0xRRGGBB
! svdag: wrong.npz: has an array "layer_kind" that is not object, material, file or frame
$ test ! -e x.svdag && svdag import wrong.npz -o x.svdag --no-layers
| x.svdag: npz, 2 voxels of 8^3, 2 DAG nodes, 1.4 KiB
|   content hash f8f82853e96fcea02f678611f13d071f

## layer_exports
# A .ply, an .npz and a .vox hold the layer of each voxel: the first, in the order of the table, with a voxel in it.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\nf 1 2 3\n' > one.obj
$ printf 'v 0 0 0\nv 8 8 0\nv 0 0 8\nf 1 2 3\n' > two.obj
$ svdag build two.obj one.obj -q -o both.svdag -r 512 --layers file
$ svdag build two.obj one.obj -q -o plain.svdag -r 512
$ svdag info both.svdag --layers | tail -2 > table
# 512^3 needs several .vox models. 4 is coarser than the cubes of the layer index (level 5).
$ for level in 9 8 7 5 4; do
>   for format in ply npz vox; do svdag export both.svdag -q -o "both_$level.$format" --level $level $([ $format != vox ] || echo --up z); done
>   for layer in one two; do svdag export both.svdag -q -o "${layer}_$level.npz" --level $level --layer $layer.obj; done
> done
$ svdag export both.svdag -q -o both_box.npz --bounds=0,0,0,3,3,3
$ svdag export plain.svdag -q -o plain_9.npz
$ cat > vox_models.py <<'EOF'
> import struct
>
> import numpy
>
>
> def chunks(data, wanted):
>     """The content of the chunks of a .vox that have this name."""
>     at, found = 20, []
>     while at < len(data):
>         name, size = struct.unpack_from("<4sI", data, at)
>         if name == wanted:
>             found.append(data[at + 12:at + 12 + size])
>         at += 12 + size
>     return found
>
>
> def models(data):
>     """x, y, z and palette number of the voxels of each model."""
>     return [numpy.frombuffer(chunk[4:], "u1").reshape(-1, 4) for chunk in chunks(data, b"XYZI")]
>
>
> def palette(data):
>     """The colours of palette numbers 1, 2, ... as r, g, b, a."""
>     [chunk] = chunks(data, b"RGBA")
>     return numpy.frombuffer(chunk, "u1").reshape(256, 4)
> EOF
$ cat > check.py <<'EOF'
> import numpy
>
> import vox_models
>
>
> def rows(*columns):
>     """One number for each row, of columns below 2^16."""
>     number = numpy.zeros(len(columns[0]), "u8")
>     for column in columns:
>         number = number << numpy.uint64(16) | column.astype("u8")
>     return number
>
>
> def cells(name):
>     return rows(*numpy.load(name)["coordinates"].T)
>
>
> table = [line.split()[-2:] for line in open("table")]
> expected_colours = numpy.array([[int(colour[i:i + 2], 16) for i in (1, 3, 5)] for colour, _ in table])
> for level in 9, 8, 7, 5, 4:
>     npz = numpy.load(f"both_{level}.npz")
>     names = npz["layer_names"].tobytes().decode().split("\0")[:-1]
>     colours = npz["layer_colours"][:, None] >> numpy.array([16, 8, 0]) & 255
>     label, xyz = npz["label"], npz["coordinates"]
>     first, both = cells(f"one_{level}.npz"), rows(*xyz.T)
>     good = [label.dtype == numpy.uint16 and len(label) == len(xyz)]
>     good.append(names == [name for _, name in table] and (colours == expected_colours).all())
>     good.append(set(both) == set(first) | set(cells(f"two_{level}.npz")))
>     good.append((label == ~numpy.isin(both, first)).all())
>
>     head, points = open(f"both_{level}.ply", "rb").read().split(b"end_header\n")
>     points = numpy.frombuffer(points, [("xyz", "<f8", 3), ("rgb", "u1", 3)])
>     centres = npz["corner"] + (xyz + 0.5) * npz["voxel_size"]
>     good.append(head.endswith(b"z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"))
>     good.append((points["xyz"] == centres).all() and (points["rgb"] == expected_colours[label]).all())
>
>     vox = open(f"both_{level}.vox", "rb").read()
>     models, palette = vox_models.models(vox), vox_models.palette(vox)
>     good.append((palette[:2, :3] == expected_colours).all() and (palette[:, 3] == 255).all())
>     voxels = rows(*numpy.concatenate(models).T)
>     good.append((numpy.sort(voxels) == numpy.sort(rows(*(xyz % 256).T, label + 1))).all())
>     print(level, numpy.bincount(label).tolist(), len(models), *map(bool, good))
>
> whole, box, plain = (numpy.load(f"{name}.npz") for name in ("both_9", "both_box", "plain_9"))
> label_of = dict(zip(rows(*whole["coordinates"].T), whole["label"]))
> print("box:", [label_of[cell] for cell in rows(*box["coordinates"].T)] == box["label"].tolist(),
>       numpy.bincount(box["label"]).tolist())
> print("without layers:", *plain)
> EOF
$ /usr/bin/python3 -B check.py
| 9 [131839, 393724] 8 True True True True True True True True
| 8 [33151, 98556] 1 True True True True True True True True
| 7 [8383, 24700] 1 True True True True True True True True
| 5 [559, 1564] 1 True True True True True True True True
| 4 [151, 396] 1 True True True True True True True True
| box: True [37249, 110784]
| without layers: coordinates resolution corner voxel_size
# Each form of the file gives the same bytes.
$ svdag convert both.svdag -q -o compact.svdag --layout compact && svdag pack both.svdag -q -o both.pack
$ for file in compact.svdag both.pack; do
>   for format in ply npz; do svdag export $file -q -o again.$format && cmp again.$format both_9.$format; done
>   svdag export $file -q -o again.vox --up z && cmp again.vox both_9.vox
> done
# Other formats have no layers: they hold the union.
$ for file in both plain; do svdag export $file.svdag -q -o $file.binvox; done && cmp both.binvox plain.binvox
# Without the union, the voxels are those of the first layer.
$ svdag build one.obj two.obj -q -o frames.svdag -r 512 --layers file --no-union
$ svdag export frames.svdag -q -o frames.npz
$ /usr/bin/python3 -B -c 'import numpy
> frames, one = numpy.load("frames.npz"), numpy.load("one_9.npz")
> print("frames:", bool((frames["coordinates"] == one["coordinates"]).all()), numpy.unique(frames["label"]).tolist())'
| frames: True [0]
# Six faces enclose a solid, whose inside is in no layer.
$ printf 'v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 0 0 8\nv 8 0 8\nv 8 8 8\nv 0 8 8\n' > faces.obj
$ for face in '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8'; do printf "o $face\nf $face\n"; done >> faces.obj
$ svdag build faces.obj -q -o solid.svdag -r 16 --layers object --rule solid
$ for format in vox npz; do svdag export solid.svdag -q -o solid.$format; done
$ /usr/bin/python3 -B -c 'import numpy, vox_models
> labels, vox = numpy.load("solid.npz")["label"], open("solid.vox", "rb").read()
> [model] = vox_models.models(vox)
> print("no layer:", numpy.sum(labels == 65535), numpy.sum(model[:, 3] == 7), vox_models.palette(vox)[6])'
| no layer: 2744 2744 [188 181 170 255]
# A .vox holds 255 layers, or 254 and voxels of no layer.
$ for i in $(seq 249); do printf 'o part%d\nf 1 2 3\nf 1 3 2\n' $i; done > more && cat faces.obj more > full.obj
$ svdag build full.obj -q -o full.svdag -r 16 --layers object --rule solid
$ svdag export full.svdag -o full.vox
! svdag: vox holds 255 colours, the file has 255 layers and voxels of no layer: export one with --layer
? 2
$ for i in $(seq 256); do printf 'o part%d\nv %d 0 0\nv %d 1 0\nv %d 0 1\nf -1 -2 -3\n' $i $i $i $i; done > many.obj
$ svdag build many.obj -q -o many.svdag -r 512 --layers object
$ svdag export many.svdag -o many.vox
! svdag: vox holds 255 colours, the file has 256 layers: export one with --layer
? 2
$ test ! -e many.vox && svdag export many.svdag -q -o many.vox --layer part7
$ svdag build many.obj -q -o fewer.svdag -r 512 --layers object --exclude part256
$ svdag export fewer.svdag -q -o fewer.vox
$ /usr/bin/python3 -B -c 'import numpy, vox_models
> numbers = numpy.concatenate(vox_models.models(open("fewer.vox", "rb").read()))[:, 3]
> print("palette numbers:", (numpy.unique(numbers) == range(1, 256)).all())'
| palette numbers: True

## layer_textures
# A material's colour is its factor times the mean of its texture, in linear light.
$ cat > write.py <<'PY'
> import base64, json, struct, sys, zlib
> def chunk(kind, data):
>     return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
> def png(*texels):  # one row of RGB or RGBA texels
>     row = b"\0" + b"".join(bytes(t) for t in texels)
>     head = struct.pack(">2I5B", len(texels), 1, 8, 2 if len(texels[0]) == 3 else 6, 0, 0, 0)
>     return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(row)) + chunk(b"IEND", b"")
> open("black white.png", "wb").write(png((0, 0, 0), (255, 255, 255)))
> open("leaf.png", "wb").write(png((10, 200, 30, 255), (255, 255, 255, 0)))
> open("broken.png", "wb").write(b"no image")
> data = "data:image/png;base64," + base64.b64encode(png((0, 0, 255), (0, 255, 255))).decode()
> names = ["checker", "half checker", "leaf", "data", "factor", "palette", "broken", "broken with factor", "ktx"]
> texture = lambda i, **more: {"pbrMetallicRoughness": {"baseColorTexture": {"index": i}, **more}}
> half = {"baseColorFactor": [0.5, 0, 1, 1]}
> materials = [texture(0), texture(0, **half), {**texture(1), "alphaMode": "MASK"}, texture(2), {"pbrMetallicRoughness": half}, {}, texture(3), texture(3, **half), texture(4)]
> points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
> json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
>            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(len(materials))]}],
>            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
>            "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "data:;base64," + base64.b64encode(points).decode(), "byteLength": 36}],
>            "materials": [{"name": n, **m} for n, m in zip(names, materials)],
>            "textures": [{"source": i} for i in range(4)] + [{"extensions": {"KHR_texture_basisu": {"source": 0}}}],
>            "images": [{"uri": "black%20white.png"}, {"uri": "leaf.png"}, {"uri": data}, {"uri": "broken.png"}]}, open("s.gltf", "w"))
> open("s.mtl", "w").write("newmtl half checker\nKd 0.7372549 0 1\nmap_Kd -s 2 2 -o 0.5 black white.png\nnewmtl leaf\nmap_Kd leaf.png\n"
>                          "newmtl missing\nmap_Kd missing.png\nKd 0 1 0\n")
> open("s.obj", "w").write("mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n" + "".join(
>     f"usemtl {n}\nf 1 2 3\n" for n in ("half checker", "leaf", "missing")))
> PY
$ python3 write.py
$ colours() { svdag info "$1" --layers | sed -n '/colour/,$p' | sed 's/^.*\(#......\) /\1/'; }
$ svdag build s.gltf -o g.svdag -r 16 --layers material | sed '/no colour/!d'
|   no colour from a texture: s.gltf: images[3]: is not a readable PNG or JPEG image: unknown image type
|   no colour from a texture: s.gltf: textures[4]: has no PNG or JPEG image
$ colours g.svdag
|               voxels          nodes      own nodes  colour   layer
| #9e804f broken
| #bc00ff broken with factor
| #bcbcbc checker
| #00bcff data
| #bc00ff factor
| #8900bc half checker
| #4f949e ktx
| #0ac81e leaf
| #cbd96c palette
$ svdag build s.gltf -o sandboxed.svdag -r 16 --layers material --sandbox -q && cmp g.svdag sandboxed.svdag
$ svdag build s.obj -o o.svdag -r 16 --layers material --report r.json | sed '/no colour/!d'
|   no colour from a texture: missing.png: cannot be opened: no such file or folder
$ colours o.svdag
|               voxels          nodes      own nodes  colour   layer
| #8900bc half checker
| #0ac81e leaf
| #00ff00 missing
$ python3 -c 'import json; r = json.load(open("r.json")); print([f["name"] for f in r["files"]], r["images_unread"])'
| ['s.obj', 's.mtl', 'black white.png', 'leaf.png'] ['missing.png: cannot be opened: no such file or folder']
# Images are inputs where their colours or their cut-outs are needed, and only there.
$ for scene in s.gltf s.obj; do svdag build $scene -o x.svdag -r 16 --layers material --report "black white.png" 2>&1 || echo "exit $?"; done
| svdag: black white.png is also an input, which is never overwritten: choose another output
| exit 2
| svdag: black white.png is also an input, which is never overwritten: choose another output
| exit 2
$ cp leaf.png kept.png && svdag build s.gltf --no-cutouts -o x.svdag -r 16 -q --report leaf.png && cp kept.png leaf.png
$ svdag build s.gltf -o x.svdag -r 16 --layers object | grep texture || echo "no texture is read"
| no texture is read
# Another image is another file, with the cells of the first.
$ echo '[{"scene": "s.obj", "output": "b.svdag", "resolution": "16"}]' > list.json
$ bake() { svdag batch list.json --layers material --report batch.json --cache cells | sed '/no colour/d; s/: .*s$/: baked/'; }
$ bake
| b.svdag: baked
| 1 of 1 baked, 0 failed
$ bake
| b.svdag: up to date
| 0 of 1 baked, 0 failed, 1 up to date
$ cp "black white.png" leaf.png
$ bake
| b.svdag: baked
| 1 of 1 baked, 0 failed
$ colours b.svdag
|               voxels          nodes      own nodes  colour   layer
| #8900bc half checker
| #bcbcbc leaf
| #00ff00 missing
# Plans hold the colours; a lack of memory is an error, not another colour.
$ svdag plan s.obj -o p.plan -r 16 --layers material --shards 2 -q && svdag run p.plan -q && cmp b.svdag p.plan/*.svdag
$ python3 - <<'PY'
> exec(open("write.py").read().split("open(")[0])
> rows = b"".join(b"\0" + bytes(1024) for _ in range(1024))
> open("leaf.png", "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", 1024, 1024, 8, 0, 0, 0, 0))
>                              + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
> PY
$ svdag build s.obj -o x.svdag -r 16 --layers material -m 16M 2>&1
| svdag: the texels of a texture need 29 MiB in total, but the memory budget is 16 MiB: raise --memory
? 5
# The diffuse colours of COLLADA, FBX, 3MF and 3DS are sRGB; their textures are not read.
$ python3 $TESTS/foreign_scenes.py f
$ sed 's|<phong/>|<phong><diffuse><color>1 0.5 0 1</color></diffuse></phong>|' f.dae > orange.dae
$ sed 's|<phong/>|<phong><diffuse><texture texture="leaf.png" texcoord="UV"/></diffuse></phong>|' f.dae > textured.dae
$ sed 's|"Material::stone", "" {|&\n Properties70: {\n P: "DiffuseColor", "Color", "", "A",1,0.5,0\n }|' f.fbx > orange.fbx
$ for name in f.dae f.fbx f.3mf f.3ds orange.dae orange.fbx textured.dae; do svdag build $name -o f.svdag -r 16 --layers material -q; echo $name; colours f.svdag | tail -n +2; done
| f.dae
| #cbd96c stone
| f.fbx
| #cbd96c stone
| f.3mf
| #bcb5aa (unnamed)
| f.3ds
| #bcb5aa (unnamed)
| orange.dae
| #ff8000 stone
| orange.fbx
| #ff8000 stone
| textured.dae
| #cbd96c stone

## layers
# Materials, objects and files become layers of one DAG; every way of baking gives the same bytes.
$ svdag-scene atrium -q -o atrium.obj
$ svdag build atrium.obj -o a.svdag -r 256 --layers material -q
$ svdag info a.svdag --layers | tail -9
|                7,155            517            229  #294d9e  blue cloth
|               66,234             49             39  #948c85  floor
|                2,543            293            136  #428533  leaves
|              124,934            451            153  #db9e6b  plaster
|                9,086            686            323  #b32129  red cloth
|               35,515          1,614            269  #b85238  roof
|              144,366          2,504            810  #ccbd9e  stone
|               13,680             45             41  #b3a899  tile
|                2,094            176            173  #a8663d  vase
$ svdag build atrium.obj -o small.svdag -r 256 --layers material -q -m 8M && cmp a.svdag small.svdag
$ for i in 1 2 3; do svdag build atrium.obj -o "$i.run" -r 256 --layers material -q --part "$i/3"; done
$ svdag merge 2.run 3.run -q -o 23.run && svdag info 23.run | grep layers
|   9 layers, one for each material
$ svdag merge 23.run 1.run -q -o merged.svdag && cmp a.svdag merged.svdag
$ svdag plan atrium.obj -o a.plan -r 256 --layers material --shards 2 -q && svdag run a.plan -q && cmp a.svdag a.plan/*.svdag
$ for i in 1 2; do svdag build atrium.obj -o cached.svdag -r 256 --layers material -q --cache cells && cmp a.svdag cached.svdag; done
$ svdag convert a.svdag -q -o compact.svdag --layout compact && svdag convert compact.svdag -q -o b.svdag --layout plain && cmp a.svdag b.svdag
$ svdag pack compact.svdag -q -o a.pack && svdag unpack a.pack -q -o b.svdag && cmp a.svdag b.svdag
$ for file in a.svdag compact.svdag a.pack; do svdag-verify check $file | tail -1; done
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
| ok: sound, in canonical order and minimal
$ svdag-verify mesh compact.svdag atrium.obj | grep layers
| layers     9 layers agree
$ svdag-verify mesh a.svdag atrium.obj --sample 1000 | tail -1
| ok: no sampled voxel differs
$ svdag build atrium.obj -o union.svdag -r 256 -q && svdag-verify diff a.svdag union.svdag -q && echo "the union is the bake without layers"
| the union is the bake without layers
# One layer alone, in every form.
$ svdag convert compact.svdag -q -o roof.svdag --layer roof && svdag-verify check roof.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag export a.pack -q -o roof.npz --layer roof && svdag import roof.npz -q -o imported.svdag && svdag-verify diff roof.svdag imported.svdag -q
$ svdag export a.svdag -q -o union.svo && svdag export union.svdag -q -o plain.svo && cmp union.svo plain.svo
$ svdag-verify render a.svdag -o a.png --size 64x36
| a.png: 64x36, colour
$ svdag-verify render compact.svdag -o c.png --size 64x36 -q && cmp a.png c.png
$ svdag-verify render a.svdag -o l.png --size 64x36 --layer leaves
| l.png: 64x36, colour
# Frames.
$ svdag-scene scan -n 3K --frames 3 -q -o wave.ply
$ svdag build wave_*.ply -o wave.svdag -r 64 --layers file --no-union -q && svdag info wave.svdag --layers | tail -9
|   13,189 voxels set, 4,243 SVO nodes, 2,687 DAG nodes (2,821 with 2x2x2 leaves)
|   31.8 KiB, 19.8 bits per voxel; as SVO 4.1 KiB
|   3 layers, one for each file, without their union: the voxels are those of the first
|   content hash 3ad7fc08994ec77213e2870829985bad
|
|               voxels          nodes      own nodes  colour   layer
|               13,189            962            847  #f2aed9  wave_0001.ply
|               13,251            949            854  #f2aeae  wave_0002.ply
|               13,188            943            850  #4f9e94  wave_0003.ply
$ svdag-verify check wave.svdag | tail -1
| ok: sound, in canonical order and minimal
$ svdag-verify mesh wave.svdag wave_*.ply | tail -4
| judge      integer: exact clipping
| triangles  8,100
| layers     3 layers agree
| ok: every voxel agrees with the scene
$ svdag-verify mesh wave.svdag wave_*.ply --judge openvdb
! svdag-verify: wave.svdag: has layers without their union, which --judge openvdb would judge: use svdag-verify mesh, or one layer (svdag convert --layer)
? 2
$ svdag-verify trace wave.svdag wave_*.ply
! svdag-verify: wave.svdag: has layers without their union, which trace would judge: use svdag-verify mesh, or one layer (svdag convert --layer)
? 2
$ svdag-verify render wave.svdag -o wave.png --frames --size 64x36
| wave_0001.png: 64x36, primary
| wave_0002.png: 64x36, primary
| wave_0003.png: 64x36, primary
# What cannot be.
$ mkdir other && cp atrium.obj other
$ svdag build atrium.obj other/atrium.obj -o x.svdag -r 64 --layers file
! svdag: --layers file: two files of the scene are named atrium.obj: rename one
? 2
$ svdag build atrium.obj -o x.svdag -r 64 --layers colour
! svdag: --layers: unknown kind "colour": choose material, object or file
? 2
$ svdag build atrium.obj -o x.svdag -r 64 --no-union
! svdag: --no-union requires --layers; see svdag build --help
? 2
$ svdag convert a.svdag -o x.svdag --layer rof
! svdag: --layer: the file has no layer "rof"; did you mean "roof"? (svdag info --layers lists them)
? 2
$ svdag convert union.svdag -o x.svdag --layer roof
! svdag: --layer: the file has no layers
? 2
$ svdag info union.svdag --layers
! svdag: --layers: union.svdag has no layers (svdag build --layers)
? 2
$ svdag-verify render union.svdag -o x.png --mode colour
! svdag-verify: --mode colour: union.svdag has neither colours nor layers (svdag build --colours, --layers)
? 2
$ svdag merge 1.run 2.run -q -o 12.run && svdag build atrium.obj -o 3.run -r 256 -q --part 3/3 && svdag merge 12.run 3.run -o x.svdag
! svdag: 12.run and 3.run are from different bakes: --layers or --no-union differs
? 2
# Formats that tell the layer of a voxel.
$ for format in ply npz; do svdag export a.svdag -q -o "a.$format" --level 6; done && svdag export a.svdag -q -o a.vox --level 6 --up z
$ /usr/bin/python3 -B - <<'EOF'
> import re, struct, numpy
> npz = numpy.load("a.npz")
> names = npz["layer_names"].tobytes().split(b"\0")[:-1]
> colours = npz["layer_colours"]
> print([name.decode() for name in names], [int(n) for n in numpy.bincount(npz["label"])])
> points = open("a.ply", "rb").read().split(b"end_header\n")[1]
> points = numpy.frombuffer(points, [("xyz", "<f8", 3), ("rgb", "u1", 3)])["rgb"].astype(int)
> print("ply:", bool((points @ [65536, 256, 1] == colours[npz["label"]]).all()))
> vox = open("a.vox", "rb").read()
> at = vox.index(b"XYZI") + 12
> count = struct.unpack_from("<I", vox, at)[0]
> voxels = numpy.frombuffer(vox, "u1", 4 * count, at + 4).reshape(-1, 4)
> palette = numpy.frombuffer(vox, "u1", 1024, vox.index(b"RGBA") + 12).reshape(-1, 4)[:, :3].astype(int) @ [65536, 256, 1]
> print("vox:", bool((voxels[:, :3] == npz["coordinates"]).all() and (palette[voxels[:, 3].astype(int) - 1] == colours[npz["label"]]).all()))
> EOF
| ['blue cloth', 'floor', 'leaves', 'plaster', 'red cloth', 'roof', 'stone', 'tile', 'vase'] [510, 4092, 184, 7012, 615, 2182, 5896, 0, 5]
| ply: True
| vox: True
$ svdag import a.npz -q -o again.svdag && svdag import a.vox -q -o vox.svdag --up z && svdag info vox.svdag | sed -n 3p && svdag info again.svdag | sed -n 3p
|   occupied: voxels 0 .. 63, 0 .. 22, 0 .. 34; (0, 0, 0) to (64, 23, 35)
|   occupied: voxels 0 .. 63, 0 .. 22, 0 .. 34; (-16.1631434, -0.563137279, -8.66314338) to (16.1631434, 11.054122, 9.01529469)

## palette
# --palette sets the colours of layers by name, at a bake and later: the same bytes.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\nv 0 0 8\nf 4 3 5\no dry leaf\nf 1 2 3\no leaf-1\nf 1 4 5\no leaf-2\nf 3 4 5\n' > a.obj
$ printf '# the studio\n\n*\t\t#102030\nleaf*    #3a7d2c\r\n  leaf-2 #FFFFFF\ndry leaf #000001\nstone* #777777\n' > palette.txt
$ svdag build a.obj -o a.svdag -r 64 --layers object -q
$ svdag build a.obj -o b.svdag -r 64 --layers object --palette palette.txt | sed 's/, [0-9.]* s$//'
| b.svdag: 64^3, 4 triangles, 14,296 voxels, 107 nodes, 3.8 KiB (2.15 bits per voxel)
|   palette: the colours of 4 of 4 layers; no layer is named stone*
$ svdag info b.svdag --layers | tail -4
|                6,238             13              0  #102030  (unnamed)
|                2,143             13              4  #000001  dry leaf
|                6,301             29              8  #3a7d2c  leaf-1
|                6,238             13              0  #ffffff  leaf-2
$ svdag convert a.svdag -o c.svdag --palette palette.txt | tail -1
|   palette: the colours of 4 of 4 layers; no layer is named stone*
$ cmp b.svdag c.svdag && svdag-verify diff a.svdag b.svdag -q && echo "only colours differ"
| only colours differ
$ svdag convert a.svdag -o c.svdag --palette palette.txt --layer 'leaf*' -q && svdag info c.svdag --layers | tail -2
|                6,301             29              7  #3a7d2c  leaf-1
|                6,238             13              3  #ffffff  leaf-2
# A compact file stays compact; colours of voxels stay.
$ svdag convert a.svdag -o compact.svdag --layout compact -q && svdag convert compact.svdag -o d.svdag --palette palette.txt -q && svdag info d.svdag | grep -o compact
| compact
$ svdag convert d.svdag -o e.svdag --layout plain -q && cmp e.svdag b.svdag
$ svdag build a.obj -o f.svdag -r 64 --layers object --palette palette.txt --colours -q && svdag convert f.svdag -o g.svdag --no-colours -q && cmp g.svdag b.svdag
$ svdag info f.svdag | tail -1 && : > none.txt && svdag convert f.svdag -o h.svdag --palette none.txt -q && svdag info h.svdag | tail -1
|   colour hash  fc5a234f8d4b526868d2b8e17d3a654e
|   colour hash  fc5a234f8d4b526868d2b8e17d3a654e
# What is not a palette, or has no layers to colour.
$ svdag build a.obj -o x.svdag -r 64 --palette palette.txt
! svdag: --palette: there are no layers to colour: add --layers
? 2
$ svdag convert a.svdag -o x.svdag --palette missing.txt
! svdag: missing.txt: cannot be opened: no such file or folder
? 3
$ printf 'leaf #3a7d2c\nstone\n' > wrong.txt && svdag convert a.svdag -o x.svdag --palette wrong.txt
! svdag: wrong.txt: line 2 is not a name and a colour, such as: leaf* #3a7d2c
? 3
$ printf 'stone #12345\n' > wrong.txt && svdag convert a.svdag -o x.svdag --palette wrong.txt
! svdag: wrong.txt: line 1 is not a name and a colour, such as: leaf* #3a7d2c
? 3
$ svdag build a.obj -o plain.svdag -r 64 -q && svdag convert plain.svdag -o x.svdag --palette palette.txt
! svdag: --palette: the file has no layers (svdag build --layers)
? 2

## one_grey_layer
# A scene without materials, and one of a single file, are grey.
$ printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nf 1 2 3\n' > a.obj
$ for kind in material file; do svdag build a.obj -o a.svdag -r 64 --layers $kind | grep grey || true; svdag info a.svdag --layers | tail -1; done
|   the scene has no materials: its layer is grey
|                2,143             13              0  #bcb5aa  (unnamed)
|                2,143             13              0  #bcb5aa  a.obj
