"""Writes a GLB: the same bytes for the same calls. Data go to a file beside it at once; the JSON, which comes first, at the end."""
import json
import os
import shutil
import struct

import numpy as np

from .._error import Error

MAX_BYTES = 2 ** 32 - 1  # lengths are 32 bits
_TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
_ARRAYS, _ELEMENTS = 34962, 34963  # bufferView.target


class Glb:
    def __init__(self, path):
        self.path = os.fspath(path)
        self.data = open(self.path + ".bin", "wb")
        self.size = 0
        self.lists = {name: [] for name in ("nodes", "meshes", "materials", "textures", "images", "samplers", "accessors",
                                            "bufferViews")}
        self.extensions = []

    def add(self, name, value):
        """Appends to one of the document's lists and returns the index."""
        self.lists[name].append(value)
        return len(self.lists[name]) - 1

    def view(self, data, **members):
        begin = self.size
        self.size += -len(data) % 4 + len(data)
        if self.size > MAX_BYTES:
            self._fail()
        self.data.write(data)
        self.data.write(bytes(-len(data) % 4))
        return self.add("bufferViews", {"buffer": 0, "byteOffset": begin, "byteLength": len(data), **members})

    def accessor(self, array, box=False):
        """float32 (n, 2 to 4) or uint32 (n,)."""
        is_index = array.dtype == np.uint32
        array = np.ascontiguousarray(array, "<u4" if is_index else "<f4")
        accessor = {"bufferView": self.view(memoryview(array).cast("B"), target=_ELEMENTS if is_index else _ARRAYS),
                    "componentType": 5125 if is_index else 5126, "count": len(array),
                    "type": _TYPES[1 if array.ndim == 1 else array.shape[1]]}
        if box:
            accessor["min"], accessor["max"] = array.min(0).tolist(), array.max(0).tolist()
            if not np.isfinite(accessor["min"] + accessor["max"]).all():
                del accessor["min"], accessor["max"]
        return self.add("accessors", accessor)

    def instances(self, **attributes):
        """The extension of a node that draws its mesh once per element of the attributes."""
        name = "EXT_mesh_gpu_instancing"
        self.extensions = [name]
        return {"extensions": {name: {"attributes": {key: self.accessor(value) for key, value in attributes.items()}}}}

    def finish(self, roots):
        self.data.close()
        document = {"asset": {"version": "2.0", "generator": "svdag-usd"}, "scene": 0, "scenes": [{"nodes": roots}]}
        if not roots:
            del document["scenes"][0]["nodes"]
        if self.extensions:
            document["extensionsUsed"] = document["extensionsRequired"] = self.extensions
        document.update((name, each) for name, each in self.lists.items() if each)
        if self.size:
            document["buffers"] = [{"byteLength": self.size}]
        text = json.dumps(document, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        size = 12 + 8 + len(text) + (8 + self.size if self.size else 0)
        if size > MAX_BYTES:
            self._fail()
        with open(self.path, "wb") as file:
            file.write(struct.pack("<4sIIII", b"glTF", 2, size, len(text), 0x4E4F534A) + text)
            if self.size:
                file.write(struct.pack("<II", self.size, 0x004E4942))
                with open(self.path + ".bin", "rb") as data:
                    shutil.copyfileobj(data, file, 1 << 22)

    def close(self):
        """Removes the file beside it, whether or not finish() was called."""
        self.data.close()
        os.unlink(self.path + ".bin")

    def _fail(self):
        raise Error("the stage needs a GLB of more than 4 GiB, the most that its lengths of 32 bits allow: bake parts of it, "
                    "as stages of their own, and join them with svdag edit", 3)
