#!/usr/bin/env python3
"""Writes paint.gltf: two squares of two triangles, in a texture of one texel and a factor. One texture coordinate of the
second is NaN, and one of its vertices has a colour of 2."""
import base64
import json
import math
import struct
import zlib


def uri(kind, content):
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def png():
    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(b"\0\xff\0\0")) + chunk(b"IEND", b""))


square = ((0, 0), (1, 0), (1, 1), (0, 1))
points = [x for z in (0, 1) for a, b in square for x in (a, b, z)]
texture = [x for z in (0, 1) for a, b in square for x in (a, b)]
colours = [1.0] * 24
texture[15], colours[23] = math.nan, 2.0
corners = [4 * k + i for k in (0, 1) for i in (0, 1, 2, 0, 2, 3)]
parts = [struct.pack("<24f", *points), struct.pack("<16f", *texture), struct.pack("<24f", *colours), struct.pack("<12H", *corners)]
json.dump({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1, "COLOR_0": 2}, "indices": 3, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "baseColorFactor": [1, 1, 0, 1]}}],
    "textures": [{"source": 0}], "images": [{"uri": uri("image/png", png())}],
    "buffers": [{"uri": uri("application/octet-stream", part), "byteLength": len(part)} for part in parts],
    "bufferViews": [{"buffer": i, "byteLength": len(part)} for i, part in enumerate(parts)],
    "accessors": [{"bufferView": i, "componentType": kind, "count": count, "type": shape} for i, (kind, count, shape) in
                  enumerate([(5126, 8, "VEC3"), (5126, 8, "VEC2"), (5126, 8, "VEC3"), (5123, 12, "SCALAR")])],
}, open("paint.gltf", "w"))
