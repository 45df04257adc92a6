# A .ply, an .npz and a .vox hold the layer of each voxel: the first, in the order of the table, with a voxel in it.
printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nv 8 8 8\nf 1 2 3\n' > one.obj
printf 'v 0 0 0\nv 8 8 0\nv 0 0 8\nf 1 2 3\n' > two.obj
svdag build two.obj one.obj -q -o both.svdag -r 512 --layers file
svdag build two.obj one.obj -q -o plain.svdag -r 512
svdag info both.svdag --layers | tail -2 > table
# 512^3 needs several .vox models. 4 is coarser than the cubes of the layer index (level 5).
for level in 9 8 7 5 4; do
  for format in ply npz vox; do svdag export both.svdag -q -o "both_$level.$format" --level $level; done
  for layer in one two; do svdag export both.svdag -q -o "${layer}_$level.npz" --level $level --layer $layer.obj; done
done
svdag export both.svdag -q -o both_box.npz --bounds=0,0,0,3,3,3
svdag export plain.svdag -q -o plain_9.npz
cat > vox_models.py <<'EOF'
import struct

import numpy


def chunks(data, wanted):
    """The content of the chunks of a .vox that have this name."""
    at, found = 20, []
    while at < len(data):
        name, size = struct.unpack_from("<4sI", data, at)
        if name == wanted:
            found.append(data[at + 12:at + 12 + size])
        at += 12 + size
    return found


def models(data):
    """x, y, z and palette number of the voxels of each model."""
    return [numpy.frombuffer(chunk[4:], "u1").reshape(-1, 4) for chunk in chunks(data, b"XYZI")]


def palette(data):
    """The colours of palette numbers 1, 2, ... as r, g, b, a."""
    [chunk] = chunks(data, b"RGBA")
    return numpy.frombuffer(chunk, "u1").reshape(256, 4)
EOF
cat > check.py <<'EOF'
import numpy

import vox_models


def rows(*columns):
    """One number for each row, of columns below 2^16."""
    number = numpy.zeros(len(columns[0]), "u8")
    for column in columns:
        number = number << numpy.uint64(16) | column.astype("u8")
    return number


def cells(name):
    return rows(*numpy.load(name)["coordinates"].T)


table = [line.split()[-2:] for line in open("table")]
expected_colours = numpy.array([[int(colour[i:i + 2], 16) for i in (1, 3, 5)] for colour, _ in table])
for level in 9, 8, 7, 5, 4:
    npz = numpy.load(f"both_{level}.npz")
    names = npz["layer_names"].tobytes().decode().split("\0")[:-1]
    colours = npz["layer_colours"][:, None] >> numpy.array([16, 8, 0]) & 255
    label, xyz = npz["label"], npz["coordinates"]
    first, both = cells(f"one_{level}.npz"), rows(*xyz.T)
    good = [label.dtype == numpy.uint16 and len(label) == len(xyz)]
    good.append(names == [name for _, name in table] and (colours == expected_colours).all())
    good.append(set(both) == set(first) | set(cells(f"two_{level}.npz")))
    good.append((label == ~numpy.isin(both, first)).all())

    head, points = open(f"both_{level}.ply", "rb").read().split(b"end_header\n")
    points = numpy.frombuffer(points, [("xyz", "<f8", 3), ("rgb", "u1", 3)])
    centres = npz["corner"] + (xyz + 0.5) * npz["voxel_size"]
    good.append(head.endswith(b"z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"))
    good.append((points["xyz"] == centres).all() and (points["rgb"] == expected_colours[label]).all())

    vox = open(f"both_{level}.vox", "rb").read()
    models, palette = vox_models.models(vox), vox_models.palette(vox)
    good.append((palette[:2, :3] == expected_colours).all() and (palette[:, 3] == 255).all())
    voxels = rows(*numpy.concatenate(models).T)
    good.append((numpy.sort(voxels) == numpy.sort(rows(*(xyz % 256).T, label + 1))).all())
    print(level, numpy.bincount(label).tolist(), len(models), *map(bool, good))

whole, box, plain = (numpy.load(f"{name}.npz") for name in ("both_9", "both_box", "plain_9"))
label_of = dict(zip(rows(*whole["coordinates"].T), whole["label"]))
print("box:", [label_of[cell] for cell in rows(*box["coordinates"].T)] == box["label"].tolist(),
      numpy.bincount(box["label"]).tolist())
print("without layers:", *plain)
EOF
/usr/bin/python3 -B check.py
# Each form of the file gives the same bytes.
svdag convert both.svdag -q -o compact.svdag --layout compact && svdag pack both.svdag -q -o both.pack
for file in compact.svdag both.pack; do
  for format in ply npz vox; do svdag export $file -q -o again.$format && cmp again.$format both_9.$format; done
done
# Other formats have no layers: they hold the union.
for file in both plain; do svdag export $file.svdag -q -o $file.binvox; done && cmp both.binvox plain.binvox
# Without the union, the voxels are those of the first layer.
svdag build one.obj two.obj -q -o frames.svdag -r 512 --layers file --no-union
svdag export frames.svdag -q -o frames.npz
/usr/bin/python3 -B -c 'import numpy
frames, one = numpy.load("frames.npz"), numpy.load("one_9.npz")
print("frames:", bool((frames["coordinates"] == one["coordinates"]).all()), numpy.unique(frames["label"]).tolist())'
# Six faces enclose a solid, whose inside is in no layer.
printf 'v 0 0 0\nv 8 0 0\nv 8 8 0\nv 0 8 0\nv 0 0 8\nv 8 0 8\nv 8 8 8\nv 0 8 8\n' > faces.obj
for face in '1 4 3 2' '5 6 7 8' '1 2 6 5' '2 3 7 6' '3 4 8 7' '4 1 5 8'; do printf "o $face\nf $face\n"; done >> faces.obj
svdag build faces.obj -q -o solid.svdag -r 16 --layers object --rule solid
for format in vox npz; do svdag export solid.svdag -q -o solid.$format; done
/usr/bin/python3 -B -c 'import numpy, vox_models
labels, vox = numpy.load("solid.npz")["label"], open("solid.vox", "rb").read()
[model] = vox_models.models(vox)
print("no layer:", numpy.sum(labels == 65535), numpy.sum(model[:, 3] == 7), vox_models.palette(vox)[6])'
# A .vox holds 255 layers, or 254 and voxels of no layer.
for i in $(seq 249); do printf 'o part%d\nf 1 2 3\nf 1 3 2\n' $i; done > more && cat faces.obj more > full.obj
svdag build full.obj -q -o full.svdag -r 16 --layers object --rule solid
svdag export full.svdag -o full.vox || echo "exit $?"
for i in $(seq 256); do printf 'o part%d\nv %d 0 0\nv %d 1 0\nv %d 0 1\nf -1 -2 -3\n' $i $i $i $i; done > many.obj
svdag build many.obj -q -o many.svdag -r 512 --layers object
svdag export many.svdag -o many.vox || echo "exit $?"
test ! -e many.vox && svdag export many.svdag -q -o many.vox --layer part7
svdag build many.obj -q -o fewer.svdag -r 512 --layers object --exclude part256
svdag export fewer.svdag -q -o fewer.vox
/usr/bin/python3 -B -c 'import numpy, vox_models
numbers = numpy.concatenate(vox_models.models(open("fewer.vox", "rb").read()))[:, 3]
print("palette numbers:", (numpy.unique(numbers) == range(1, 256)).all())'
