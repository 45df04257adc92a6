"""Materials of a stage as those of a GLB: UsdPreviewSurface, and displayColor where a mesh has no material."""
import math

import numpy as np
from pxr import Ar, Sdf, UsdGeom, UsdShade

_WRAPS = {"clamp": 33071, "black": 33071, "mirror": 33648}
_REPEAT = 10497


def _source(shader, name, time, default=None):
    """What feeds an input, through any interface: a value, or a shader and the name of its output."""
    attributes = UsdShade.Utils.GetValueProducingAttributes(shader.GetInput(name)) if shader.GetInput(name) else []
    for attribute in attributes:
        if UsdShade.Utils.GetType(attribute.GetName()) == UsdShade.AttributeType.Output:
            return None, UsdShade.Shader(attribute.GetPrim()), attribute.GetBaseName()
        value = attribute.Get(time)
        if value is not None:
            return value, None, ""
    return default, None, ""


class Coordinates:
    """A primvar of texture coordinates and the transform that a material applies to it; v is flipped to glTF's."""

    def __init__(self, shader, time):
        self.primvar, self.scale, self.rotation, self.translation = "st", (1, 1), 0.0, (0, 0)
        _, reader, _ = _source(shader, "st", time)
        if reader and reader.GetShaderId() == "UsdTransform2d":
            self.scale = tuple(_source(reader, "scale", time, (1, 1))[0] or (1, 1))
            self.rotation = float(_source(reader, "rotation", time, 0.0)[0] or 0)
            self.translation = tuple(_source(reader, "translation", time, (0, 0))[0] or (0, 0))
            _, reader, _ = _source(reader, "in", time)
        if reader and reader.GetShaderId().startswith("UsdPrimvarReader"):
            self.primvar = str(_source(reader, "varname", time, "st")[0] or "st")

    def key(self):
        return self.primvar, self.scale, self.rotation, self.translation

    def of(self, prim, time):
        """The values (n, 2) and the interpolation, or None."""
        primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance(self.primvar)
        values = primvar.ComputeFlattened(time) if primvar else None
        if values is None:
            return None
        values = np.asarray(values, np.float64)
        if values.ndim != 2 or values.shape[1] != 2:
            return None
        scaled = values * self.scale
        sine, cosine = math.sin(math.radians(self.rotation)), math.cos(math.radians(self.rotation))
        u = scaled[:, 0] * cosine - scaled[:, 1] * sine + self.translation[0]
        v = scaled[:, 0] * sine + scaled[:, 1] * cosine + self.translation[1]
        return np.stack([u, 1 - v], -1).astype(np.float32), primvar.GetInterpolation()


class Materials:
    """Each material is written at its first use. `left` counts what is not."""

    def __init__(self, glb, time, left):
        self.glb, self.time, self.left = glb, time, left
        self.known, self.coordinates, self.images = {}, {}, {}

    def of(self, prim):
        """The number of the material bound to a prim, or None."""
        bound = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial(UsdShade.Tokens.preview)[0]
        if not bound:
            return None
        material = bound.GetPrim()
        key = material.GetPrimInPrototype().GetPath() if material.IsInstanceProxy() else material.GetPath()
        if key not in self.known:
            self.known[key] = self._write(bound)
        return self.known[key]

    def of_colour(self, prim):
        """The number of a material of the prim's displayColor, or None."""
        primvar = UsdGeom.PrimvarsAPI(prim).FindPrimvarWithInheritance("displayColor")
        values = primvar.Get(self.time) if primvar else None
        if values is None or len(values) == 0:
            return None
        values = np.asarray(values, np.float64)
        if (values != values[0]).any():
            self.left["note", "colours that vary over a mesh, of which the mean is taken"] += 1
        colour = tuple(float(c) for c in np.clip(np.nan_to_num(values.mean(0)), 0, 1).astype(np.float32))
        if colour not in self.known:
            name = "displayColor " + " ".join(f"{c:.6g}" for c in colour)
            pbr = {"baseColorFactor": [*colour, 1.0]}
            self.known[colour] = self.glb.add("materials", {"name": name, "pbrMetallicRoughness": pbr})
        return self.known[colour]

    def _write(self, bound):
        material = {"name": str(bound.GetPath())}
        number = self.glb.add("materials", material)
        shader = bound.ComputeSurfaceSource()[0]
        if not shader or shader.GetShaderId() != "UsdPreviewSurface":
            self.left["note", "materials without a UsdPreviewSurface, which have no colour"] += 1
            return number
        colour, texture, channel = _source(shader, "diffuseColor", self.time, (0.18, 0.18, 0.18))
        pbr = {}
        if texture:
            index = self._texture(texture, number)
            if index is not None:
                pbr["baseColorTexture"] = {"index": index}
                scale = _source(texture, "scale", self.time, (1, 1, 1, 1))[0] or (1, 1, 1, 1)
                pbr["baseColorFactor"] = [min(max(float(c), 0.0), 1.0) for c in scale[:3]] + [1.0]
        elif colour is not None:
            pbr["baseColorFactor"] = [min(max(float(c), 0.0), 1.0) for c in colour] + [1.0]
        self._opacity(shader, texture, pbr, material)
        if pbr:
            material["pbrMetallicRoughness"] = pbr
        return number

    def _opacity(self, shader, texture, pbr, material):
        threshold = float(_source(shader, "opacityThreshold", self.time, 0.0)[0] or 0)
        opacity, source, channel = _source(shader, "opacity", self.time, 1.0)
        if source:
            if not texture or source.GetPath() != texture.GetPath() or channel != "a":
                self.left["note", "materials whose opacity is not the alpha of their colour's texture, taken as opaque"] += 1
                return
        elif opacity is not None and opacity < 1:
            pbr.setdefault("baseColorFactor", [1.0, 1.0, 1.0, 1.0])[3] = max(float(opacity), 0.0)
        else:
            return
        material["alphaMode"] = "MASK" if threshold > 0 else "BLEND"
        if threshold > 0:
            material["alphaCutoff"] = threshold

    def _texture(self, shader, material):
        """The number of a UsdUVTexture with a PNG or JPEG file that exists, or None."""
        if shader.GetShaderId() != "UsdUVTexture":
            self.left["note", "colours that are not a value or a UsdUVTexture"] += 1
            return None
        asset = _source(shader, "file", self.time)[0]
        path = asset.path if isinstance(asset, Sdf.AssetPath) else ""
        if "<UDIM>" in path:
            self.left["out", "UDIM textures"] += 1
            return None
        image = self._image(asset.resolvedPath) if path else None
        if image is None:
            self.left["out", "textures that are missing or neither PNG nor JPEG"] += 1
            return None
        self.coordinates[material] = Coordinates(shader, self.time)
        wraps = [_WRAPS.get(str(_source(shader, name, self.time)[0]), _REPEAT) for name in ("wrapS", "wrapT")]
        sampler = {"wrapS": wraps[0], "wrapT": wraps[1]}
        samplers = self.glb.lists["samplers"]
        if sampler not in samplers:
            self.glb.add("samplers", sampler)
        return self.glb.add("textures", {"source": image, "sampler": samplers.index(sampler)})

    def _image(self, path):
        if path not in self.images:
            asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(path)) if path else None
            data = bytes(asset.GetBuffer()) if asset else b""
            kind = "image/png" if data.startswith(b"\x89PNG") else "image/jpeg" if data.startswith(b"\xff\xd8\xff") else None
            self.images[path] = kind and self.glb.add("images", {"bufferView": self.glb.view(data), "mimeType": kind})
        return self.images[path]
