# Labels of an .npz and colours of a .vox become layers.
printf 'v 0 0 0\nv 8 0 0\nv 0 8 0\nf 1 2 3\n' > floor.obj
printf 'v 0 0 4\nv 8 8 4\nv 0 0 8\nf 1 2 3\n' > wall.obj
svdag build floor.obj wall.obj -q -o a.svdag -r 64 --layers file && svdag info a.svdag --layers | tail -2
for format in npz vox; do
  svdag export a.svdag -q -o a.$format
  svdag import a.$format -o $format.svdag -r 64
  svdag-verify check $format.svdag | tail -1
  svdag info $format.svdag --layers | tail -2
  svdag import a.$format -o plain.svdag -r 64 --no-layers
  svdag-verify diff plain.svdag $format.svdag -q
done
svdag-verify diff npz.svdag a.svdag --layer floor.obj -q
svdag import a.npz -o json.svdag --json | grep layers
# Other formats have no layers.
svdag export a.svdag -q -o a.binvox && svdag import a.binvox -o b.svdag
# Wrong arrays: one message each.
cat > wrong.py <<'EOP'
import io
import sys
import zipfile

import numpy

arrays = {"coordinates": numpy.array([[0, 0, 0], [1, 2, 3]]), "label": numpy.array([0, 1], "<u2"), "layer_names": b"a\0b\0"}
arrays.update({name: eval(value) for name, value in (argument.split("=") for argument in sys.argv[1:])})
with zipfile.ZipFile("wrong.npz", "w") as archive:
    for name, array in arrays.items():
        data = io.BytesIO()
        numpy.save(data, numpy.frombuffer(array, "u1") if isinstance(array, bytes) else array)
        archive.writestr(name + ".npy", data.getvalue())
EOP
for change in "label=numpy.array([0,2])" "label=numpy.array([0])" "label=numpy.array([0.,1.])" "layer_names=b'a'" "layer_names=b'a\0a\0'" \
  "layer_names=numpy.array([1.,2.])" "layer_colours=numpy.array([1])" "layer_colours=numpy.array([1,1<<24])" "layer_kind=b'thing\0'"; do
  /usr/bin/python3 -B wrong.py "$change"
  svdag import wrong.npz -o x.svdag || echo "exit $?"
done
test ! -e x.svdag && svdag import wrong.npz -o x.svdag --no-layers
