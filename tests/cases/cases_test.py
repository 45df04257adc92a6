#!/usr/bin/env python3
"""Small files as other programs write them: each is read rightly, and what is left out is counted.

Usage: cases_test.py PROGRAMS

CASES: file: (triangles or voxels, corners of the bounding box, what is left out). A scene of the unit cube has 12 triangles and is
closed.
"""
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest

PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
FOLDER = pathlib.Path(__file__).resolve().parent
CUBE = [0, 0, 0, 1, 1, 1]
SCENES = {
    "obj_trailing_nul.obj": (12, CUBE, {}),
    "obj_vw.obj": (12, CUBE, {}),
    "obj_t_crease.obj": (12, CUBE, {}),
    "stl_end_solid.stl": (12, CUBE, {}),
    "stl_end_loop.stl": (12, CUBE, {}),
    "stl_words_after.stl": (12, CUBE, {}),
    "stl_no_endsolid.stl": (12, CUBE, {"no_end": 1}),
    "stl_tail.stl": (12, CUBE, {"bytes_after": 136}),
    "ply_unknown_header_line.ply": (12, CUBE, {"header_lines": 1}),
    "gltf_float_integers.gltf": (12, CUBE, {}),
    "gltf_hidden_node.gltf": (12, [3, 0, 0, 4, 1, 1], {"hidden": 1}),
    "gltf_35_indices.gltf": (11, CUBE, {"corners_left": 2}),
    "gltf_bare_percent.gltf": (12, CUBE, {}),
    "gltf_ext_meshopt.gltf": (12, CUBE, {}),
    "gltf_khr_meshopt.gltf": (12, CUBE, {}),
    "gltf_khr_meshopt_v1.gltf": (912, [-100, -100, -100, 100, 100, 100], {}),
    "gltf_khr_meshopt_v1_bytes.gltf": (912, [-100, -100, -100, 100, 100, 100], {}),
    "gltf_mask_all_transparent.gltf": (12, CUBE, {}),
    "gltf_draco_int16_normalized.gltf": (12, CUBE, {}),
    "gltf_draco_int16.gltf": (12, [0, 0, 0, 32767, 32767, 32767], {}),
    "dae_colour_with_space.dae": (12, CUBE, {}),
    "dae_utf16.dae": (12, CUBE, {}),
    "3mf_thumbnail.3mf": (12, CUBE, {}),
    "3mf_component_path.3mf": (12, CUBE, {}),
    "3mf_item_path.3mf": (12, CUBE, {}),
    "3mf_surface_type.3mf": (12, CUBE, {}),
    "3mf_inch.3mf": (12, CUBE, {}),
    "3mf_same_ids.3mf": (24, [0, 0, 0, 4, 1, 1], {}),
    "fbx_6100.fbx": (12, [3, 0, 0, 4, 1, 1], {}),
    "fbx_blend_shape.fbx": (12, CUBE, {}),
    "fbx_blend_shape_no_normals.fbx": (12, CUBE, {}),
    "fbx_front_axis.fbx": (12, [-1, 0, 5, 0, 1, 6], {}),
    "fbx_geometric.fbx": (24, [0, 0, 0, 11, 6, 1], {}),
    "fbx_geometric_rotated.fbx": (12, [-1, 10, 0, 0, 11, 1], {}),
    "fbx_hidden.fbx": (12, [3, 0, 0, 4, 1, 1], {"hidden": 1}),
    "fbx_post_rotation.fbx": (12, [0, -(3 ** 0.5) / 2, -1, 0.5 + 3 ** 0.5 / 2, 0.5, 0], {}),
}
OF_LIBRARIES = ("draco", "meshopt", ".dae", ".3mf", ".fbx")
UNITS = {"3mf_thumbnail.3mf": [0.001], "3mf_inch.3mf": [0.0254], "fbx_6100.fbx": [0.01]}
UNDEFORMED = ("fbx_blend_shape.fbx", "fbx_blend_shape_no_normals.fbx")
REFUSED = {"3mf_beams_only.3mf": "1 beam of beam lattices is not baked"}
VOXELS = {"vox_rotated.vox": 5, "npz_compressed.npz": 2, "npy_big_endian.npy": 2}


def run(*words):
    return subprocess.run([PROGRAMS / words[0], *words[1:]], capture_output=True, text=True)


class Cases(unittest.TestCase):
    def test_scenes_are_read_rightly(self):
        for name, (triangles, bounds, left_out) in SCENES.items():
            with self.subTest(name=name):
                done = run("svdag", "info", FOLDER / name, "--json")
                if any(word in name for word in OF_LIBRARIES) and "svdag cannot read" in done.stderr:
                    continue  # this build lacks the library
                self.assertEqual(done.returncode, 0, done.stderr)
                info = json.loads(done.stdout)
                self.assertEqual(info["triangles"], triangles)
                for got, own in zip(info["bounds"], bounds):
                    self.assertAlmostEqual(got, own, delta=1e-5)
                self.assertEqual(info["left_out"], left_out)
                self.assertEqual(info["units"], UNITS.get(name, info["units"]))
                self.assertEqual(info["undeformed"], 12 if name in UNDEFORMED else 0)
                self.assertEqual(info["open_edges"] == 0, triangles != 11)

    def test_what_is_left_out_is_one_line_of_the_summary_and_a_count_of_the_report(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            scene = FOLDER / "gltf_hidden_node.gltf"
            bake = ("svdag", "build", scene, "-r", "16", "-o", folder / "a.svdag", "--report", folder / "a.json")
            done = run(*bake)
            self.assertIn("  1 hidden node is not baked; --hidden bakes hidden nodes\n", done.stdout)
            self.assertEqual(json.loads((folder / "a.json").read_text())["left_out"], {"hidden": 1})
            self.assertIn("24 triangles", run(*bake, "--hidden").stdout)
            self.assertEqual(run("svdag-verify", "mesh", folder / "a.svdag", scene, "--hidden").returncode, 0)

    def test_a_scene_of_what_svdag_does_not_bake_is_refused_with_the_reason(self):
        for name, words in REFUSED.items():
            done = run("svdag", "info", FOLDER / name)
            if "svdag cannot read" in done.stderr:
                continue
            self.assertEqual(done.returncode, 3, done.stdout)
            self.assertIn(words, done.stderr)

    def test_voxel_files_are_read_rightly(self):
        with tempfile.TemporaryDirectory() as name:
            out = pathlib.Path(name) / "a.svdag"
            for case, voxels in VOXELS.items():
                with self.subTest(name=case):
                    self.assertEqual(run("svdag", "import", FOLDER / case, "-o", out, "-q").returncode, 0)
                    self.assertEqual(json.loads(run("svdag", "info", out, "--json").stdout)["voxels"], voxels)

    def test_every_case_is_tested(self):
        files = {path.name for path in FOLDER.iterdir() if path.suffix not in (".py", ".bin", ".cmake")}
        self.assertEqual(files, set(SCENES) | set(VOXELS) | set(REFUSED))


if __name__ == "__main__":
    unittest.main()
