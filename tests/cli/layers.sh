# Materials, objects and files become layers of one DAG; every way of baking gives the same bytes.
svdag-scene atrium -q -o atrium.obj
svdag build atrium.obj -o a.svdag -r 256 --layers material -q
svdag info a.svdag --layers | tail -9
svdag build atrium.obj -o small.svdag -r 256 --layers material -q -m 8M && cmp a.svdag small.svdag
for i in 1 2 3; do svdag build atrium.obj -o "$i.run" -r 256 --layers material -q --part "$i/3"; done
svdag merge 2.run 3.run -q -o 23.run && svdag info 23.run | grep layers
svdag merge 23.run 1.run -q -o merged.svdag && cmp a.svdag merged.svdag
svdag plan atrium.obj -o a.plan -r 256 --layers material --shards 2 -q && svdag run a.plan -q && cmp a.svdag a.plan/*.svdag
for i in 1 2; do svdag build atrium.obj -o cached.svdag -r 256 --layers material -q --cache cells && cmp a.svdag cached.svdag; done
svdag convert a.svdag -q -o compact.svdag --layout compact && svdag convert compact.svdag -q -o b.svdag --layout plain && cmp a.svdag b.svdag
svdag pack compact.svdag -q -o a.pack && svdag unpack a.pack -q -o b.svdag && cmp a.svdag b.svdag
for file in a.svdag compact.svdag a.pack; do svdag-verify check $file | tail -1; done
svdag-verify mesh compact.svdag atrium.obj | grep -c "0 missing, 0 extra"
svdag-verify mesh a.svdag atrium.obj --sample 1000 | tail -1
svdag build atrium.obj -o union.svdag -r 256 -q && svdag-verify diff a.svdag union.svdag -q && echo "the union is the bake without layers"
# One layer alone, in every form.
svdag convert compact.svdag -q -o roof.svdag --layer roof && svdag-verify check roof.svdag | tail -1
svdag export a.pack -q -o roof.npz --layer roof && svdag import roof.npz -q -o imported.svdag && svdag-verify diff roof.svdag imported.svdag -q
svdag export a.svdag -q -o union.svo && svdag export union.svdag -q -o plain.svo && cmp union.svo plain.svo
svdag-verify render a.svdag -o a.png --size 64x36
svdag-verify render compact.svdag -o c.png --size 64x36 -q && cmp a.png c.png
svdag-verify render a.svdag -o l.png --size 64x36 --layer leaves
# Frames.
svdag-scene scan -n 3K --frames 3 -q -o wave.ply
svdag build wave_*.ply -o wave.svdag -r 64 --layers file --no-union -q && svdag info wave.svdag --layers | tail -9
svdag-verify check wave.svdag | tail -1
svdag-verify mesh wave.svdag wave_*.ply | tail -4
svdag-verify mesh wave.svdag wave_*.ply --judge openvdb || echo "exit $?"
svdag-verify trace wave.svdag wave_*.ply || echo "exit $?"
svdag-verify render wave.svdag -o wave.png --frames --size 64x36
# What cannot be.
mkdir other && cp atrium.obj other
svdag build atrium.obj other/atrium.obj -o x.svdag -r 64 --layers file || echo "exit $?"
svdag build atrium.obj -o x.svdag -r 64 --layers colour || echo "exit $?"
svdag build atrium.obj -o x.svdag -r 64 --no-union || echo "exit $?"
svdag convert a.svdag -o x.svdag --layer rof || echo "exit $?"
svdag convert union.svdag -o x.svdag --layer roof || echo "exit $?"
svdag info union.svdag --layers || echo "exit $?"
svdag-verify render union.svdag -o x.png --mode colour || echo "exit $?"
svdag merge 1.run 2.run -q -o 12.run && svdag build atrium.obj -o 3.run -r 256 -q --part 3/3 && svdag merge 12.run 3.run -o x.svdag || echo "exit $?"
# Formats that tell the layer of a voxel.
for format in ply npz vox; do svdag export a.svdag -q -o "a.$format" --level 6; done
/usr/bin/python3 -B - <<'EOF'
import re, struct, numpy
npz = numpy.load("a.npz")
names = npz["layer_names"].tobytes().split(b"\0")[:-1]
colours = npz["layer_colours"]
print([name.decode() for name in names], [int(n) for n in numpy.bincount(npz["label"])])
points = open("a.ply", "rb").read().split(b"end_header\n")[1]
points = numpy.frombuffer(points, [("xyz", "<f8", 3), ("rgb", "u1", 3)])["rgb"].astype(int)
print("ply:", bool((points @ [65536, 256, 1] == colours[npz["label"]]).all()))
vox = open("a.vox", "rb").read()
at = vox.index(b"XYZI") + 12
count = struct.unpack_from("<I", vox, at)[0]
voxels = numpy.frombuffer(vox, "u1", 4 * count, at + 4).reshape(-1, 4)
palette = numpy.frombuffer(vox, "u1", 1024, vox.index(b"RGBA") + 12).reshape(-1, 4)[:, :3].astype(int) @ [65536, 256, 1]
print("vox:", bool((voxels[:, :3] == npz["coordinates"]).all() and (palette[voxels[:, 3].astype(int) - 1] == colours[npz["label"]]).all()))
EOF
svdag import a.npz -q -o again.svdag && svdag import a.vox -q -o vox.svdag && svdag info vox.svdag | sed -n 3p && svdag info again.svdag | sed -n 3p
