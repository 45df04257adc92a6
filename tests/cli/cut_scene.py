#!/usr/bin/env python3
"""cut_scene.py N [MODE [KEY]]: writes cut.glb: N cards and a floor, in three materials: cut by a noisy texture (repeated),
by a smooth one (mirrored and clamped, to the nearest texel), and whole, or with this alphaMode. Cards of the last have
their texture coordinates as attribute KEY. Also cut.obj, cut.mtl and noisy.png: the first and the last material, cut by
map_d, or without MODE MASK whole with the texture as map_Kd."""
import json
import random
import struct
import sys
import zlib

words = sys.argv[1:] + ["", "OPAQUE", "TEXCOORD_0"][len(sys.argv) - 1:]
N, MODE, KEY = int(words[0]), *words[1:]
rng = random.Random(5)


def png(width, height, alpha):
    rows = b"".join(b"\0" + b"".join(bytes((90, 140, 60, alpha(i, j))) for i in range(width)) for j in range(height))

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 6, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def main():
    data, views, accessors, parts = b"", [], [], []

    def view(content):
        nonlocal data
        data += b"\0" * (-len(data) % 4)
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(content)})
        data += content
        return len(views) - 1

    def accessor(values, kind, width, code="f", component=5126):
        accessors.append({"bufferView": view(struct.pack(f"<{len(values)}{code}", *values)), "componentType": component,
                          "count": len(values) // width, "type": kind})
        return len(accessors) - 1

    def cards(count, material, key="TEXCOORD_0"):
        points, texture, corners = [], [], []
        for k in range(count):
            at, u, v = ([rng.uniform(-s, s) for _ in range(3)] for s in (10, 1, 1))
            for a, b in ((0, 0), (1, 0), (1, 1), (0, 1)):
                points += [at[i] + a * u[i] + b * v[i] for i in range(3)]
                texture += [3 * a - 1, 2.5 * b - 0.75]
            corners += [4 * k + i for i in (0, 1, 2, 0, 2, 3)]
        parts.append((points, texture))
        return {"attributes": {"POSITION": accessor(points, "VEC3", 3), key: accessor(texture, "VEC2", 2)},
                "indices": accessor(corners, "SCALAR", 1, "I", 5125), "material": material}

    primitives = [cards(N, 0), cards(N, 1), cards(N // 4, 2, KEY)]
    images = [{"bufferView": view(png(31, 17, lambda i, j: rng.choice((0, 60, 200, 255)))), "mimeType": "image/png"},
              {"bufferView": view(png(16, 16, lambda i, j: min(255, (i - 8) ** 2 + (j - 8) ** 2 + 60))), "mimeType": "image/png"}]

    def material(name, texture, **more):
        return {"name": name, "pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}, **more}

    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "name": "cards"}],
        "meshes": [{"primitives": primitives}], "images": images,
        "samplers": [{}, {"magFilter": 9728, "wrapS": 33648, "wrapT": 33071}],
        "textures": [{"source": 0, "sampler": 0}, {"source": 1, "sampler": 1}],
        "materials": [material("noisy", 0, alphaMode="MASK"), material("smooth", 1, alphaMode="MASK", alphaCutoff=0.4),
                      material("whole", 0, alphaMode=MODE)],
        "buffers": [{"byteLength": len(data)}], "bufferViews": views, "accessors": accessors}
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    with open("cut.glb", "wb") as out:
        out.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A) + text +
                  struct.pack("<II", len(data), 0x004E4942) + data)

    def row(word, values):
        return " ".join([word, *(repr(x) for x in values)]) + "\n"

    with open("cut.obj", "w") as out:
        out.write("mtllib cut.mtl\n")
        for name, (points, texture) in (("noisy", parts[0]), ("whole", parts[2])):
            points = struct.unpack(f"<{len(points)}f", struct.pack(f"<{len(points)}f", *points))
            out.write(f"usemtl {name}\n")
            for k in range(0, len(points) // 3, 4):
                out.writelines(row("v", points[3 * i:3 * i + 3]) for i in range(k, k + 4))
                out.writelines(row("vt", (texture[2 * i], 1 - texture[2 * i + 1])) for i in range(k, k + 4))
                out.write("f -4/-4 -3/-3 -2/-2\nf -4/-4/1 -2/-2/1 -1/-1/1\nvn 0 0 1\n" if k == 0 else "f -4/-4 -3/-3 -2/-2 -1/-1\n")
    with open("cut.mtl", "w") as out:
        out.write(f"newmtl noisy\nmap_d noisy.png\nnewmtl whole\n{'map_d' if MODE == 'MASK' else 'map_Kd'} noisy.png\n")
    with open("noisy.png", "wb") as out:
        out.write(data[views[images[0]["bufferView"]]["byteOffset"]:][:views[images[0]["bufferView"]]["byteLength"]])


main()
