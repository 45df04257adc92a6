#!/usr/bin/env python3
"""Tests svdag-usd: a stage bakes to the voxels of its triangles, given directly in metres with y up.

Usage: usd_test.py [TEST...], by the Python of the environment that has the package and usd-core.
"""
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

import numpy as np
from pxr import Usd  # noqa: F401

import svdag

QUAD = """point3f[] points = [(0,0,0), (1,0,0), (1,2,0), (0,2,1)]
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
"""
POINTS = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [0, 2, 1]], float)
FACES = np.array([[0, 1, 2], [0, 2, 3]])
METRES = 'metersPerUnit = 1\n upAxis = "Y"'


def moved(*offsets):
    """The quad at each of the offsets."""
    return (np.concatenate([POINTS + o for o in offsets]),
            np.concatenate([FACES + 4 * i for i in range(len(offsets))]))


class Stages(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory(prefix="svdag-usd-")
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def stage(self, body, head=METRES):
        path = self.folder / "stage.usda"
        path.write_text(f"#usda 1.0\n({head}\n)\n{body}\n")
        return path

    def check(self, body, expected, head=METRES, **options):
        """Bakes the stage and the expected triangles; returns the counts of the stage."""
        report = svdag.build_usd(self.stage(body, head), self.folder / "usd.svdag", resolution=256, **options)
        svdag.build(*expected, self.folder / "direct.svdag", resolution=256)
        with svdag.open(self.folder / "usd.svdag") as a, svdag.open(self.folder / "direct.svdag") as b:
            self.assertEqual(a.content_hash, b.content_hash)
        self.assertFalse(list(self.folder.glob("*.usd")), "the scratch of the stage is left")
        return report["usd"]

    def refused(self, body, sentence, code=3, **options):
        (self.folder / "usd.svdag").unlink(missing_ok=True)
        with self.assertRaises(svdag.Error) as caught:
            svdag.build_usd(self.stage(body), self.folder / "usd.svdag", resolution=64, **options)
        self.assertIn(sentence, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(caught.exception.code, code)
        self.assertFalse((self.folder / "usd.svdag").exists())


class Geometry(Stages):
    def test_a_polygon_is_a_fan_and_a_cage_is_noted(self):
        counts = self.check(f'def Mesh "m" {{\n{QUAD}}}', (POINTS, FACES))
        self.assertEqual(counts["notes"], {"subdivision cages, taken as polygons": 1})

    def test_a_concave_polygon_is_not_covered_outside(self):
        points = np.array([[0, 0, 0], [4, 0, 0], [4, 4, 0], [3, 1, 0], [1, 1, 0], [0, 4, 0]], float)
        body = ('def Mesh "m" {\npoint3f[] points = [(0,0,0),(4,0,0),(4,4,0),(3,1,0),(1,1,0),(0,4,0)]\n'
                'int[] faceVertexCounts = [6]\nint[] faceVertexIndices = [0,1,2,3,4,5]\n}')
        self.check(body, (points, [[0, 1, 4], [1, 3, 4], [1, 2, 3], [0, 4, 5]]))

    def test_centimetres_and_z_up_become_metres_and_y_up(self):
        expected = np.stack([POINTS[:, 0] * 0.5, POINTS[:, 2] * 0.5, POINTS[:, 1] * -0.5], -1)
        self.check(f'def Mesh "m" {{\n{QUAD}}}', (expected, FACES), 'metersPerUnit = 0.5\n upAxis = "Z"')

    def test_nested_transforms(self):
        body = f'''def Xform "a" {{
    double3 xformOp:translate = (8, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    def Mesh "m" {{
    double3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:scale"]
    {QUAD}}}
}}'''
        self.check(body, (POINTS * 2 + [8, 0, 0], FACES))

    def test_time_samples_move_at_a_time_and_are_noted_without(self):
        body = f'''def Mesh "m" {{
    double3 xformOp:translate.timeSamples = {{0: (0, 0, 0), 10: (8, 0, 0)}}
    uniform token[] xformOpOrder = ["xformOp:translate"]
    {QUAD}}}
def Mesh "still" {{\n{QUAD}}}'''
        self.check(body, moved((4, 0, 0), (0, 0, 0)), time=5)
        counts = self.check(body, (POINTS, FACES))
        self.assertIn("prims that move with time, taken at the default time (--time)", counts["notes"])

    def test_cubes_are_baked_and_spheres_counted(self):
        x, y, z = np.meshgrid([-2, 2], [-2, 2], [-2, 2], indexing="ij")
        points = np.stack([x, y, z], -1).reshape(-1, 3).astype(float)
        quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
        faces = [t for q in quads for t in (q[:3], [q[0], q[2], q[3]])]
        counts = self.check('def Cube "c" {\ndouble size = 4\n}\ndef Sphere "s" {\n}', (points, faces))
        self.assertEqual(counts["left_out"], {"Sphere": 1})


class Selection(Stages):
    def test_hidden_prims_and_purposes_are_left_out_and_counted(self):
        body = f'''def Mesh "m" {{\n{QUAD}}}
def Xform "h" {{
    token visibility = "invisible"
    def Mesh "m" {{\n{QUAD}}}
}}
def Mesh "p" {{
    uniform token purpose = "proxy"
    double3 xformOp:translate = (8, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
    {QUAD}}}'''
        counts = self.check(body, (POINTS, FACES))
        self.assertEqual(counts["left_out"], {"hidden prims and all below them": 1, "prims of purpose proxy": 1})
        self.check(body, moved((0, 0, 0), (8, 0, 0)), purposes=("default", "proxy"))

    def test_variants(self):
        body = f'''def Xform "a" (
    variants = {{string size = "small"}}
    prepend variantSets = "size"
) {{
    variantSet "size" = {{
        "small" {{ def Mesh "m" {{\n{QUAD}}}
        }}
        "none" {{ def Mesh "n" {{\n{QUAD}
    double3 xformOp:translate = (3, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
        }}
    }}
}}
def Mesh "still" {{\n{QUAD}}}'''
        self.check(body, (POINTS, FACES))
        self.check(body, moved((3, 0, 0), (0, 0, 0)), variants=["/a:size=none"])
        self.refused(body, "not one of its variants", 2, variants=["/a:size=huge"])

    def test_subsets_are_materials_and_prims_are_objects(self):
        body = '''def Mesh "m" (
    prepend apiSchemas = ["MaterialBindingAPI"]
) {
    point3f[] points = [(0,0,0),(1,0,0),(0,1,0),(5,0,0),(6,0,0),(5,1,0)]
    int[] faceVertexCounts = [3, 3]
    int[] faceVertexIndices = [0,1,2, 3,4,5]
    rel material:binding = </Red>
    def GeomSubset "s" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    ) {
        uniform token elementType = "face"
        uniform token familyName = "materialBind"
        int[] indices = [1]
        rel material:binding = </Blue>
    }
}
''' + "".join(f'''def Material "{name}" {{
    token outputs:surface.connect = </{name}/S.outputs:surface>
    def Shader "S" {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:diffuseColor = {colour}
        token outputs:surface
    }}
}}
''' for name, colour in (("Red", "(1,0,0)"), ("Blue", "(0,0,1)")))
        svdag.build_usd(self.stage(body), self.folder / "m.svdag", resolution=64, layers="material")
        with svdag.open(self.folder / "m.svdag") as file:
            self.assertEqual({layer.name: layer.colour for layer in file.layers}, {"/Red": (255, 0, 0), "/Blue": (0, 0, 255)})
        svdag.build_usd(self.stage(body), self.folder / "o.svdag", resolution=64, layers="object")
        with svdag.open(self.folder / "o.svdag") as file:
            self.assertEqual([layer.name for layer in file.layers], ["/m"])


class Instances(Stages):
    def instancer(self, prototype, more=""):
        return f'''def PointInstancer "i" {{
    int[] protoIndices = [0, 0, 0]
    point3f[] positions = [(0,0,0), (4,0,0), (0,4,2)]
    {more}
    rel prototypes = </i/p>
    {prototype}
}}'''

    def test_point_instancers_draw_one_mesh(self):
        counts = self.check(self.instancer(f'def Mesh "p" {{\n{QUAD}}}'), moved((0, 0, 0), (4, 0, 0), (0, 4, 2)))
        self.assertEqual((counts["meshes"], counts["instances"], counts["triangles"]), (1, 3, 6))

    def test_prototypes_with_transforms_are_nodes(self):
        prototype = f'''def Xform "p" {{
        double3 xformOp:translate = (1, 0, 0)
        uniform token[] xformOpOrder = ["xformOp:translate"]
        def Mesh "m" {{\n{QUAD}}}
    }}'''
        self.check(self.instancer(prototype), moved((1, 0, 0), (5, 0, 0), (1, 4, 2)))

    def test_orientations_and_scales_come_before_positions(self):
        half_turn = "quath[] orientations = [(1,0,0,0), (0,0,1,0), (1,0,0,0)]\nfloat3[] scales = [(1,1,1), (2,2,2), (1,1,1)]"
        points, faces = moved((0, 0, 0), (0, 0, 0), (0, 4, 2))
        points[4:8] = POINTS * 2 * [-1, 1, -1] + [4, 0, 0]
        self.check(self.instancer(f'def Mesh "p" {{\n{QUAD}}}', half_turn), (points, faces))

    def test_hidden_instances_are_counted(self):
        counts = self.check(self.instancer(f'def Mesh "p" {{\n{QUAD}}}', "int64[] invisibleIds = [1]"),
                            moved((0, 0, 0), (0, 4, 2)))
        self.assertEqual(counts["left_out"], {"hidden instances of point instancers": 1})

    def test_native_instances_share_a_mesh(self):
        body = f'class "c" {{\ndef Mesh "m" {{\n{QUAD}}}\n}}\n' + "".join(f'''def Xform "i{x}" (
    instanceable = true
    references = </c>
) {{
    double3 xformOp:translate = ({x}, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}}
''' for x in (0, 4))
        counts = self.check(body, moved((0, 0, 0), (4, 0, 0)))
        self.assertEqual((counts["meshes"], counts["instances"]), (1, 2))


class Hostile(Stages):
    def test_broken_stages_are_one_sentence(self):
        self.refused('def Xform "a" (references = @none.usda@) {\n}', "has a part that cannot be loaded")
        self.refused('def Xform "a" {', "is not a USD stage that can be opened")
        self.refused(f'def Mesh "m" {{\n{QUAD.replace("[4]", "[5]")}}}', "/m: has 4 corners, but its faces need 5")
        self.refused(f'def Mesh "m" {{\n{QUAD.replace("2, 3]", "2, 9]")}}}', "/m: has the vertex index 9 in a mesh of only 4")
        self.refused(f'def Mesh "m" {{\n{QUAD.replace("(1,0,0)", "(nan,0,0)")}}}', "/m: has the point 1, which is not finite")

    def test_a_stage_has_the_same_bytes_each_time(self):
        stage = self.stage(f'def Mesh "m" {{\n{QUAD}}}')
        for name in ("a", "b"):
            svdag.build_usd(stage, self.folder / "o.svdag", resolution=64, keep=self.folder / f"{name}.glb")
        self.assertEqual((self.folder / "a.glb").read_bytes(), (self.folder / "b.glb").read_bytes())

    def test_the_program(self):
        run = [sys.executable, "-c", "import svdag.usd; svdag.usd.main()"]
        stage, out = self.stage(f'def Mesh "m" {{\n{QUAD}}}'), self.folder / "o.svdag"
        done = subprocess.run([*run, stage, "-o", out, "--", "-s", "5cm"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("1 meshes in 1 places, 2 triangles, units of 1 m, y up", done.stderr)
        with svdag.open(out) as file:
            self.assertEqual(file.voxel_size, 0.05)
        done = subprocess.run([*run, self.folder / "none.usd", "-o", out, "--", "-r", "64"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 3)
        # Without usd-core: the module is hidden.
        hide = "import sys; sys.modules['pxr'] = None; import svdag.usd; svdag.usd.main()"
        done = subprocess.run([sys.executable, "-c", hide, stage, "-o", out, "--", "-r", "64"], capture_output=True, text=True,
                              env=dict(os.environ))
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertIn("pip install usd-core", done.stderr)


class Materials(Stages):
    def test_a_texture_below_the_opacity_threshold_is_cut_out(self):
        def chunk(kind, body):
            return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

        # Grey and alpha: the lower half of four rows is transparent.
        rows = b"".join(b"\0" + bytes((128, 255 if y < 2 else 0)) * 4 for y in range(4))
        (self.folder / "half.png").write_bytes(
            b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", 4, 4, 8, 4, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))
        stage = self.stage("""def Mesh "card" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    point3f[] points = [(0,0,0), (1,0,0), (1,1,0), (0,1,0)]
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    texCoord2f[] primvars:st = [(0,0), (1,0), (1,1), (0,1)] (interpolation = "vertex")
    rel material:binding = </leaf>
}
def Material "leaf" {
    token outputs:surface.connect = </leaf/surface.outputs:surface>
    def Shader "surface" {
        uniform token info:id = "UsdPreviewSurface"
        float inputs:opacity.connect = </leaf/image.outputs:a>
        color3f inputs:diffuseColor.connect = </leaf/image.outputs:rgb>
        float inputs:opacityThreshold = 0.5
        token outputs:surface
    }
    def Shader "image" {
        uniform token info:id = "UsdUVTexture"
        asset inputs:file = @./half.png@
        float2 inputs:st.connect = </leaf/st.outputs:result>
        token inputs:wrapS = "clamp"
        token inputs:wrapT = "clamp"
        float outputs:a
        color3f outputs:rgb
    }
    def Shader "st" {
        uniform token info:id = "UsdPrimvarReader_float2"
        string inputs:varname = "st"
        float2 outputs:result
    }
}""")
        svdag.build_usd(stage, self.folder / "usd.svdag", resolution=64)
        with svdag.open(self.folder / "usd.svdag") as dag:
            top = dag.occupied(np.array([[0.5, 0.9, 0.001], [0.5, 0.55, 0.001]]))
            bottom = dag.occupied(np.array([[0.5, 0.1, 0.001], [0.5, 0.4, 0.001]]))
        self.assertTrue(top.all() and not bottom.any())


if __name__ == "__main__":
    unittest.main(verbosity=2)
