# The buffers of a glTF file are inputs too; other files in their folder may be outputs.
python3 - <<'PY'
import json, struct
open("s.bin", "wb").write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
           "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
           "bufferViews": [{"buffer": 0, "byteLength": 36}],
           "buffers": [{"uri": "s.bin", "byteLength": 36}]}, open("s.gltf", "w"))
PY
cp s.bin kept.bin
svdag build s.gltf -r 16 -o s.bin 2>&1 || echo "exit $?"
svdag build s.gltf -r 16 -o s.svdag --report ./s.bin 2>&1 || echo "exit $?"
echo '[{"scene": "s.gltf", "resolution": 16, "output": "s.svdag"},
       {"scene": "s.gltf", "resolution": 16, "output": "s.bin"}]' > l.json
svdag build --batch l.json 2>&1 || echo "exit $?"
svdag build --batch l.json --report s.bin 2>&1 || echo "exit $?"
cmp s.bin kept.bin
svdag build s.gltf -r 16 -o s.svdag -q
svdag build s.gltf -r 16 -o s.svdag -q
cmp s.bin kept.bin
ls
