"""A USD stage as a GLB in metres with y up: meshes once, each place that draws them a node named by its prim's path.

Positions are the stage's floats in each mesh's own space, transforms matrices in double; a stage in metres with y up is not
converted. Nodes are in the order of the stage, so that a stage gives the same bytes each time. What is not converted, or taken
otherwise than usdview shows it, is counted.
"""
import collections
import os
import re
from typing import NamedTuple, Optional, Tuple

import numpy as np
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdShade, UsdUtils

from .._error import Error
from .glb import Glb
from .materials import Materials
from .polygons import triangulate

_IDENTITY = Gf.Matrix4d(1)
_Z_UP = Gf.Matrix4d(1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1)  # (x, y, z) becomes (x, z, -y)
_BAD_INPUT = 3
_CUBE = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
_CUBE_FACES = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
_PLANE = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)


class Draw(NamedTuple):
    mesh: int
    triangles: int
    name: str
    matrix: Gf.Matrix4d
    instances: Optional[Tuple] = None  # translations, rotations, scales: applied before the matrix


def _sentence(error):
    """The first message in what USD throws or collects."""
    text = str(error)
    found = re.search(r"at line \d+ in file \S+ : '(.*?)'\s*$", text, re.DOTALL | re.MULTILINE)
    return " ".join((found.group(1) if found else text).split())


def open_stage(path, variants):
    """variants: (prim, set, name) triples. Raises Error for a stage of which a part cannot be loaded."""
    if not os.path.exists(path):
        raise Error(f"{path}: cannot be opened: No such file or directory", _BAD_INPUT, path)
    try:
        stage = Usd.Stage.Open(path)
        stage.SetEditTarget(stage.GetSessionLayer())
        for prim_path, set_name, name in variants:
            prim = stage.GetPrimAtPath(prim_path) if Sdf.Path.IsValidPathString(prim_path) else None
            if not prim:
                raise Error(f"--variant {prim_path}:{set_name}={name}: the stage has no prim {prim_path}", 2, path)
            choices = prim.GetVariantSets().GetVariantSet(set_name).GetVariantNames()
            if name not in choices:
                known = ", ".join(choices) if choices else "the prim has no such variant set"
                raise Error(f"--variant {prim_path}:{set_name}={name}: not one of its variants: {known}", 2, path)
            prim.GetVariantSets().GetVariantSet(set_name).SetVariantSelection(name)
        errors = stage.GetCompositionErrors()
    except (Tf.ErrorException, RuntimeError) as error:
        raise Error(f"{path}: is not a USD stage that can be opened: {_sentence(error)}", _BAD_INPUT, path) from None
    if errors:
        raise Error(f"{path}: has a part that cannot be loaded: {_sentence(errors[0])}", _BAD_INPUT, path)
    return stage


class Converter:
    def __init__(self, stage, path, glb, time, purposes, skip_invalid):
        self.stage, self.path, self.glb = stage, path, glb
        self.time = Usd.TimeCode.Default() if time is None else Usd.TimeCode(time)
        self.purposes, self.skip_invalid = purposes, skip_invalid
        self.left = collections.Counter()  # ("out" or "note", what): count
        self.materials = Materials(glb, self.time, self.left)
        self.meshes = {}  # by geometry and materials: number and triangles, or None if nothing is drawn
        self.prototypes = {}  # what prototypes of point instancers draw
        self.open = []  # point instancers that are being expanded

    def convert(self):
        draws = self.collect(self.stage.GetPseudoRoot(), _IDENTITY, None)
        nodes = [self.glb.add("nodes", self.node(draw)) for draw in draws]
        unit = UsdGeom.GetStageMetersPerUnit(self.stage)
        if not (np.isfinite(unit) and unit > 0):
            self.fail("metersPerUnit", f"is {unit:g}, not a positive number")
        if not UsdGeom.StageHasAuthoredMetersPerUnit(self.stage):
            self.left["note", f"metersPerUnit is not given, which means {unit:g}"] = 0
        to_metres = Gf.Matrix4d(1).SetScale(unit)
        if UsdGeom.GetStageUpAxis(self.stage) == UsdGeom.Tokens.z:
            to_metres = _Z_UP * to_metres
        if to_metres != _IDENTITY and nodes:
            nodes = [self.glb.add("nodes", {"children": nodes, "matrix": self.numbers(to_metres)})]
        self.glb.finish(nodes)
        count = [1 if draw.instances is None else len(draw.instances[0]) for draw in draws]
        return {"meshes": len(self.glb.lists["meshes"]), "instances": sum(count),
                "triangles": sum(n * draw.triangles for n, draw in zip(count, draws)),
                "metres_per_unit": unit, "up_axis": str(UsdGeom.GetStageUpAxis(self.stage)).lower(),
                "left_out": {what: n for (kind, what), n in self.left.items() if kind == "out"},
                "notes": {what: n for (kind, what), n in self.left.items() if kind == "note"}}

    def fail(self, prim, what):
        name = prim if isinstance(prim, str) else prim.GetPath()
        raise Error(f"{self.path}: {name}: {what}", _BAD_INPUT, self.path)

    def numbers(self, matrix):
        return [float(value) for row in matrix for value in row]  # rows of USD are columns of glTF

    def node(self, draw):
        node = {"name": draw.name, "mesh": draw.mesh}
        if draw.matrix != _IDENTITY:
            node["matrix"] = self.numbers(draw.matrix)
            if not np.isfinite(node["matrix"]).all():
                self.fail(draw.name, "has a transform that is not finite")
        if draw.instances is not None:
            names = ("TRANSLATION", "ROTATION", "SCALE")
            node.update(self.glb.instances(**{k: v for k, v in zip(names, draw.instances) if v is not None}))
        return node

    # --- The prims below one, depth first.

    def collect(self, top, matrix, purpose, predicate=Usd.PrimDefaultPredicate):
        draws = []
        stack = [(top, matrix, purpose)]
        while stack:
            prim, matrix, purpose = stack.pop()
            imageable = UsdGeom.Imageable(prim)
            if imageable:
                if imageable.GetVisibilityAttr().Get(self.time) == UsdGeom.Tokens.invisible:
                    self.left["out", "hidden prims and all below them"] += 1
                    continue
                purpose = imageable.ComputePurposeInfo(purpose) if purpose else imageable.ComputePurposeInfo()
            xformable = UsdGeom.Xformable(prim)
            if xformable:
                if xformable.GetResetXformStack():
                    matrix = _IDENTITY
                local = xformable.GetLocalTransformation(self.time)
                matrix = local * matrix if local != _IDENTITY else matrix
                if self.time.IsDefault() and xformable.TransformMightBeTimeVarying():
                    self.left["note", "prims that move with time, taken at the default time (--time)"] += 1
            if prim.IsA(UsdGeom.PointInstancer):
                if self.has_purpose(purpose):
                    draws += self.instances(prim, matrix, purpose)
                continue  # what is below are its prototypes
            if prim.IsA(UsdGeom.Gprim):
                if self.has_purpose(purpose):
                    self.draw(prim, matrix, draws)
            elif prim.GetTypeName() and not prim.IsA(Usd.Typed):
                self.left["out", f"{prim.GetTypeName()}, an unknown type"] += 1
            children = prim.GetFilteredChildren(Usd.TraverseInstanceProxies(predicate))
            stack += [(child, matrix, purpose) for child in reversed(children)]
        return draws

    def has_purpose(self, purpose):
        if purpose.purpose in self.purposes:
            return True
        self.left["out", f"prims of purpose {purpose.purpose}"] += 1
        return False

    def draw(self, prim, matrix, draws):
        if prim.IsA(UsdGeom.Mesh):
            found = self.mesh(prim)
        elif prim.IsA(UsdGeom.Cube):
            size = UsdGeom.Cube(prim).GetSizeAttr().Get(self.time)
            matrix = Gf.Matrix4d(1).SetScale((2.0 if size is None else size) / 2) * matrix
            found = self.shape(prim, "Cube", _CUBE, _CUBE_FACES)
        elif prim.IsA(UsdGeom.Plane):
            plane = UsdGeom.Plane(prim)
            width, length = plane.GetWidthAttr().Get(self.time) / 2, plane.GetLengthAttr().Get(self.time) / 2
            axis = plane.GetAxisAttr().Get(self.time)
            rows = {"X": [(0, 0, width), (0, length, 0), (1, 0, 0)], "Y": [(width, 0, 0), (0, 0, length), (0, 1, 0)]}.get(
                axis, [(width, 0, 0), (0, length, 0), (0, 0, 1)])
            matrix = Gf.Matrix4d(*[v for row in rows for v in (*row, 0)], 0, 0, 0, 1) * matrix
            found = self.shape(prim, "Plane", _PLANE, [[0, 1, 2, 3]])
        else:
            self.left["out", str(prim.GetTypeName())] += 1
            return
        if found is not None:
            draws.append(Draw(*found, str(prim.GetPath()), matrix))

    # --- Meshes: a number and its triangles.

    def material(self, prim):
        number = self.materials.of(prim)
        return self.materials.of_colour(prim) if number is None else number

    def shape(self, prim, name, points, faces):
        material = self.material(prim)
        key = (name, material)
        if key not in self.meshes:
            indices = np.array([(f[0], f[k], f[k + 1]) for f in faces for k in range(1, len(f) - 1)], np.uint32)
            primitive = {"attributes": {"POSITION": self.glb.accessor(points, box=True)},
                         "indices": self.glb.accessor(indices.ravel())}
            if material is not None:
                primitive["material"] = material
            self.meshes[key] = self.glb.add("meshes", {"name": name, "primitives": [primitive]}), len(indices)
        return self.meshes[key]

    def mesh(self, prim):
        subsets = UsdGeom.Subset.GetGeomSubsets(UsdGeom.Imageable(prim), UsdGeom.Tokens.face, UsdShade.Tokens.materialBind)
        own = self.material(prim)
        parts = []
        for subset in subsets:
            number = self.materials.of(subset.GetPrim())
            parts.append((subset, own if number is None else number))
        where = prim.GetPrimInPrototype().GetPath() if prim.IsInstanceProxy() else prim.GetPath()
        key = (where, own, *[number for _, number in parts])
        if key not in self.meshes:
            self.meshes[key] = self.write_mesh(prim, own, parts)
        return self.meshes[key]

    def write_mesh(self, prim, own, parts):
        mesh = UsdGeom.Mesh(prim)
        points, counts, indices = (attribute.Get(self.time) for attribute in (
            mesh.GetPointsAttr(), mesh.GetFaceVertexCountsAttr(), mesh.GetFaceVertexIndicesAttr()))
        if self.time.IsDefault() and mesh.GetPointsAttr().GetNumTimeSamples() > 0:
            self.left["note", "meshes that change with time, taken at the default time (--time)"] += 1
        if not points or not counts or not indices:
            self.left["out", "meshes without points or faces"] += 1
            return None
        points, counts, indices = np.asarray(points), np.asarray(counts), np.asarray(indices)
        self.check(prim, points, counts, indices)
        self.note_mesh(prim, mesh, counts)
        corners, faces = triangulate(points, counts, indices)
        part_of_face = np.zeros(len(counts), np.int32)
        numbers = [own]
        for subset, number in reversed(parts):  # of two that hold a face, the first counts
            of = np.asarray(subset.GetIndicesAttr().Get(self.time) or [], np.int64)
            if len(of) and not (of.min() >= 0 and of.max() < len(counts)):
                self.fail(subset.GetPrim(), f"has a face that is not 0 to {len(counts) - 1}")
            if number not in numbers:
                numbers.append(number)
            part_of_face[of] = numbers.index(number)
        holes = np.asarray(mesh.GetHoleIndicesAttr().Get(self.time) or [], np.int64)
        holes = holes[(holes >= 0) & (holes < len(counts))]
        if len(holes):
            self.left["out", "faces that are holes"] += len(holes)
            part_of_face[holes] = -1
        part = part_of_face[faces]
        primitives, triangles = [], 0
        for i, number in enumerate(numbers):
            chosen = corners if len(numbers) == 1 and not len(holes) else corners[part == i]
            if len(chosen):
                triangles += len(chosen)
                primitives.append(self.primitive(prim, points, counts, indices, chosen.ravel(), number,
                                                 len(chosen) < len(corners)))
        if not primitives:
            self.left["out", "meshes without points or faces"] += 1
            return None
        return self.glb.add("meshes", {"name": str(prim.GetPath()), "primitives": primitives}), triangles

    def check(self, prim, points, counts, indices):
        if counts.min() < 0 or counts.sum(dtype=np.int64) != len(indices):
            self.fail(prim, f"has {len(indices):,} corners, but its faces need {counts.sum(dtype=np.int64):,}")
        if indices.min() < 0 or indices.max() >= len(points):
            wrong = indices.min() if indices.min() < 0 else indices.max()
            self.fail(prim, f"has the vertex index {wrong} in a mesh of only {len(points)} vertices")
        if not self.skip_invalid and not np.isfinite(points).all():
            index = np.flatnonzero(~np.isfinite(points).all(1))[0]
            self.fail(prim, f"has the point {index}, which is not finite: --skip-invalid drops its triangles")

    def note_mesh(self, prim, mesh, counts):
        few = int((counts < 3).sum())
        if few:
            self.left["out", "faces of fewer than three corners"] += few
        if mesh.GetSubdivisionSchemeAttr().Get(self.time) != UsdGeom.Tokens.none:
            self.left["note", "subdivision cages, taken as polygons"] += 1
        if prim.GetAttribute("primvars:skel:jointIndices").HasAuthoredValue() or prim.GetRelationship(
                "skel:blendShapeTargets").HasAuthoredTargets():
            self.left["note", "skinned or blended meshes, taken as stored"] += 1

    def primitive(self, prim, points, counts, indices, corners, material, is_part):
        """corners: of triangles, positions in `indices`."""
        vertices = indices[corners].astype(np.int64)
        primitive = {"attributes": {}}
        if material is not None:
            primitive["material"] = material
        values = None
        if material in self.materials.coordinates:
            found = self.materials.coordinates[material].of(prim, self.time)
            values = self.corner_values(found, points, counts, indices, corners, vertices) if found else None
            if values is None:
                self.left["note", "textured meshes without the coordinates that their material reads"] += 1
        if values is not None and len(values) == len(corners):
            points = points[vertices]  # each corner is a vertex: the triangles need no indices
        else:
            if is_part:
                used = np.zeros(len(points), bool)
                used[vertices] = True
                vertices = (np.cumsum(used) - 1)[vertices]
                points = points[used]
                values = values if values is None else values[used]
            primitive["indices"] = self.glb.accessor(vertices.astype(np.uint32))
        primitive["attributes"]["POSITION"] = self.glb.accessor(points, box=True)
        if values is not None:
            primitive["attributes"]["TEXCOORD_0"] = self.glb.accessor(values)
        return primitive

    @staticmethod
    def corner_values(found, points, counts, indices, corners, vertices):
        """A value for each corner; None if their number is not what their interpolation needs."""
        values, interpolation = found
        if interpolation == UsdGeom.Tokens.faceVarying:
            return values[corners] if len(values) == len(indices) else None
        if interpolation in (UsdGeom.Tokens.vertex, UsdGeom.Tokens.varying):
            return values[vertices] if len(values) == len(points) else None
        if interpolation == UsdGeom.Tokens.uniform:
            face = np.repeat(np.arange(len(counts)), counts)
            return values[face[corners]] if len(values) == len(counts) else None
        return np.repeat(values, len(corners), 0) if len(values) == 1 else None

    # --- Point instancers.

    def instances(self, prim, matrix, purpose):
        instancer = UsdGeom.PointInstancer(prim)
        if prim.GetPath() in self.open:
            self.fail(prim, "is its own prototype")
        which = np.asarray(instancer.GetProtoIndicesAttr().Get(self.time) or [], np.int64)
        targets = instancer.GetPrototypesRel().GetForwardedTargets()
        if len(which) == 0:
            self.left["out", "point instancers without instances"] += 1
            return []
        if which.min() < 0 or which.max() >= len(targets):
            self.fail(prim, f"has an instance of a prototype that is not 0 to {len(targets) - 1}")
        translations = self.per_instance(prim, instancer.GetPositionsAttr(), 3, len(which))
        if translations is None:
            self.fail(prim, f"has {len(which):,} instances, but no positions")
        orientations = instancer.GetOrientationsfAttr() if hasattr(instancer, "GetOrientationsfAttr") else None
        if orientations is None or not orientations.HasAuthoredValue():
            orientations = instancer.GetOrientationsAttr()
        rotations = self.per_instance(prim, orientations, 4, len(which))
        if rotations is not None:
            rotations[~(rotations != 0).any(1)] = (0, 0, 0, 1)
        scales = self.per_instance(prim, instancer.GetScalesAttr(), 3, len(which))
        if not self.time.IsDefault() and instancer.GetVelocitiesAttr().HasAuthoredValue():
            self.left["note", "point instancers whose velocities are not applied"] += 1
        if self.time.IsDefault() and instancer.GetPositionsAttr().GetNumTimeSamples() > 0:
            self.left["note", "point instancers that change with time, taken at the default time (--time)"] += 1
        shown = np.ones(len(which), bool)
        mask = instancer.ComputeMaskAtTime(self.time)
        if mask is not None and len(mask) == len(which):
            shown = np.asarray(mask, bool)
            self.left["out", "hidden instances of point instancers"] += int((~shown).sum())
        self.open.append(prim.GetPath())
        draws = []
        for number, target in enumerate(targets):
            chosen = np.flatnonzero(shown & (which == number))
            if len(chosen):
                trs = [values if values is None else values[chosen] for values in (translations, rotations, scales)]
                for draw in self.prototype(prim, target, purpose):
                    draws += self.place(draw, f"{prim.GetPath()}{draw.name}", matrix, trs)
        self.open.pop()
        return draws

    def per_instance(self, prim, attribute, width, count):
        values = attribute.Get(self.time)
        if values is None or len(values) == 0:
            return None
        if len(values) != count:
            self.fail(prim, f"has {count:,} instances, but {len(values):,} {attribute.GetName()}")
        values = np.array(values, np.float32).reshape(count, width)
        if not np.isfinite(values).all():
            self.fail(prim, f"has {attribute.GetName()} that are not finite")
        return values

    def prototype(self, instancer, target, purpose):
        """What a prototype draws, in its parent's space. Names are paths below the prototype's parent."""
        key = (target, purpose.purpose)
        if key not in self.prototypes:
            prim = self.stage.GetPrimAtPath(target)
            if not prim:
                self.fail(instancer, f"has the prototype {target}, which does not exist")
            predicate = Usd.PrimIsActive & Usd.PrimIsLoaded
            parent = len(str(target.GetParentPath()).rstrip("/"))
            self.prototypes[key] = [draw._replace(name=draw.name[parent:])
                                    for draw in self.collect(prim, _IDENTITY, purpose, predicate)]
        return self.prototypes[key]

    @staticmethod
    def place(draw, name, matrix, trs):
        """A node with instances if these are all that moves the mesh, else a node for each instance."""
        if draw.instances is None and draw.matrix == _IDENTITY:
            return [Draw(draw.mesh, draw.triangles, name, matrix, tuple(trs))]
        return [Draw(draw.mesh, draw.triangles, name, draw.matrix * each * matrix, draw.instances) for each in matrices(trs)]


def matrices(trs):
    """Translations, rotations and scales as matrices, by the formula of io/scene/gltf."""
    translations, rotations, scales = (None if v is None else v.astype(np.float64) for v in trs)
    count = len(translations)
    m = np.zeros((count, 4, 4))
    m[:, 3, 3] = 1
    if rotations is None:
        m[:, (0, 1, 2), (0, 1, 2)] = 1
    else:
        x, y, z, w = rotations.T
        n = ((x * x + y * y) + z * z) + w * w
        rows = [[((w * w + x * x) - y * y) - z * z, 2 * (x * y - w * z), 2 * (x * z + w * y)],
                [2 * (x * y + w * z), ((w * w + y * y) - z * z) - x * x, 2 * (y * z - w * x)],
                [2 * (x * z - w * y), 2 * (y * z + w * x), ((w * w + z * z) - x * x) - y * y]]
        for r in range(3):
            for c in range(3):
                m[:, c, r] = rows[r][c] / n
    if scales is not None:
        m[:, :3, :3] *= scales[:, :, None]
    m[:, 3, :3] = translations
    return [Gf.Matrix4d(each.tolist()) for each in m]


def write_glb(path, glb_path, time=None, purposes=("default", "render"), variants=(), skip_invalid=False):
    """Writes the stage as a GLB and returns counts of what it holds, what is left out and what is taken otherwise."""
    delegate = UsdUtils.CoalescingDiagnosticDelegate()  # USD's own messages do not reach stderr
    try:
        path = os.fspath(path)
        stage = open_stage(path, variants)
        glb = Glb(glb_path)
        try:
            return Converter(stage, path, glb, time, purposes, skip_invalid).convert()
        finally:
            glb.close()
    except Tf.ErrorException as error:
        raise Error(f"{path}: {_sentence(error)}", _BAD_INPUT, path) from None
    except MemoryError:
        raise Error(f"{path}: does not fit in memory", 5, path) from None
    except OSError as error:
        raise Error(f"{error.filename or glb_path}: {error.strerror}", 4, str(error.filename or glb_path)) from None
    finally:
        delegate.TakeUncoalescedDiagnostics()
