# The report names every file of the scene, buffers of glTF included, by size and XXH3-128.
python3 - <<'SCENE'
import json, struct
open("corners.bin", "wb").write(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0))
json.dump({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
           "buffers": [{"uri": "corners.bin", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
           "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                          "min": [0, 0, 0], "max": [1, 1, 0]}]}, open("triangle.gltf", "w"))
SCENE
svdag-scene rectangle -q -o r.ply
svdag build r.ply triangle.gltf -r 64 -o a.svdag --report a.json -q
/usr/bin/python3 - <<'PROOF'
import json, os, xxhash
for file in json.load(open("a.json"))["files"]:
    content = open(file["name"], "rb").read()
    print(file["name"], file["bytes"] == len(content), file["hash"] == xxhash.xxh3_128_hexdigest(content))
PROOF
