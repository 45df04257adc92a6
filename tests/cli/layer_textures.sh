# A material's colour is its factor times the mean of its texture, in linear light.
cat > write.py <<'PY'
import base64, json, struct, sys, zlib
def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
def png(*texels):  # one row of RGB or RGBA texels
    row = b"\0" + b"".join(bytes(t) for t in texels)
    head = struct.pack(">2I5B", len(texels), 1, 8, 2 if len(texels[0]) == 3 else 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(row)) + chunk(b"IEND", b"")
open("black white.png", "wb").write(png((0, 0, 0), (255, 255, 255)))
open("leaf.png", "wb").write(png((10, 200, 30, 255), (255, 255, 255, 0)))
open("broken.png", "wb").write(b"no image")
data = "data:image/png;base64," + base64.b64encode(png((0, 0, 255), (0, 255, 255))).decode()
names = ["checker", "half checker", "leaf", "data", "factor", "palette", "broken", "broken with factor", "ktx"]
texture = lambda i, **more: {"pbrMetallicRoughness": {"baseColorTexture": {"index": i}, **more}}
half = {"baseColorFactor": [0.5, 0, 1, 1]}
materials = [texture(0), texture(0, **half), {**texture(1), "alphaMode": "MASK"}, texture(2), {"pbrMetallicRoughness": half}, {}, texture(3), texture(3, **half), texture(4)]
points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
           "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": i} for i in range(len(materials))]}],
           "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
           "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "data:;base64," + base64.b64encode(points).decode(), "byteLength": 36}],
           "materials": [{"name": n, **m} for n, m in zip(names, materials)],
           "textures": [{"source": i} for i in range(4)] + [{"extensions": {"KHR_texture_basisu": {"source": 0}}}],
           "images": [{"uri": "black%20white.png"}, {"uri": "leaf.png"}, {"uri": data}, {"uri": "broken.png"}]}, open("s.gltf", "w"))
open("s.mtl", "w").write("newmtl half checker\nKd 0.7372549 0 1\nmap_Kd -s 2 2 -o 0.5 black white.png\nnewmtl leaf\nmap_Kd leaf.png\n"
                         "newmtl missing\nmap_Kd missing.png\nKd 0 1 0\n")
open("s.obj", "w").write("mtllib s.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\n" + "".join(
    f"usemtl {n}\nf 1 2 3\n" for n in ("half checker", "leaf", "missing")))
PY
python3 write.py
colours() { svdag info "$1" --layers | sed -n '/colour/,$p' | sed 's/^.*\(#......\) /\1/'; }
svdag build s.gltf -o g.svdag -r 16 --layers material | sed '/no colour/!d'
colours g.svdag
svdag build s.gltf -o sandboxed.svdag -r 16 --layers material --sandbox -q && cmp g.svdag sandboxed.svdag
svdag build s.obj -o o.svdag -r 16 --layers material --report r.json | sed '/no colour/!d'
colours o.svdag
python3 -c 'import json; r = json.load(open("r.json")); print([f["name"] for f in r["files"]], r["images_unread"])'
# Images are inputs where their colours are needed, and only there.
for scene in s.gltf s.obj; do svdag build $scene -o x.svdag -r 16 --layers material --report "black white.png" 2>&1 || echo "exit $?"; done
cp leaf.png kept.png && svdag build s.gltf -o x.svdag -r 16 -q --report leaf.png && cp kept.png leaf.png
svdag build s.gltf -o x.svdag -r 16 --layers object | grep texture || echo "no texture is read"
# Another image is another file, with the cells of the first.
echo '[{"scene": "s.obj", "output": "b.svdag", "resolution": "16"}]' > list.json
bake() { svdag build --batch list.json --layers material --report batch.json --cache cells | sed '/no colour/d; s/: .*s$/: baked/'; }
bake
bake
cp "black white.png" leaf.png
bake
colours b.svdag
# Plans hold the colours; a lack of memory is an error, not another colour.
svdag plan s.obj -o p.plan -r 16 --layers material --shards 2 -q && svdag run p.plan -q && cmp b.svdag p.plan/*.svdag
python3 - <<'PY'
exec(open("write.py").read().split("open(")[0])
rows = b"".join(b"\0" + bytes(1024) for _ in range(1024))
open("leaf.png", "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">2I5B", 1024, 1024, 8, 0, 0, 0, 0))
                             + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
PY
svdag build s.obj -o x.svdag -r 16 --layers material -m 16M 2>&1 || echo "exit $?"
# The diffuse colours of COLLADA, FBX, 3MF and 3DS are sRGB; their textures are not read.
python3 $TESTS/foreign_scenes.py f
sed 's|<phong/>|<phong><diffuse><color>1 0.5 0 1</color></diffuse></phong>|' f.dae > orange.dae
sed 's|<phong/>|<phong><diffuse><texture texture="leaf.png" texcoord="UV"/></diffuse></phong>|' f.dae > textured.dae
sed 's|"Material::stone", "" {|&\n Properties70: {\n P: "DiffuseColor", "Color", "", "A",1,0.5,0\n }|' f.fbx > orange.fbx
for name in f.dae f.fbx f.3mf f.3ds orange.dae orange.fbx textured.dae; do svdag build $name -o f.svdag -r 16 --layers material -q; echo $name; colours f.svdag | tail -n +2; done
