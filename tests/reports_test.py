#!/usr/bin/env python3
"""Tests that docs/reports.md documents exactly the keys of the JSON that the programs print.

The keys are collected from reports of small bakes and from verdicts of both outcomes. Keys that are data (the bins of
a histogram) are not collected.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
BAKES = """svdag-scene city -n 6K -o city.ply
svdag-scene scan -n 2K -o scan.ply
svdag build city.ply -o city.svdag -r 64 --report report.json
svdag build city.ply -o thin.svdag -r 64 --rule thin
svdag build scan.ply -o solid.svdag -r 64 --rule solid
svdag build city.ply -o half.run -r 64 --part 1/2
svdag export thin.svdag -o thin.vdb
svdag build city.ply scan.ply -o layers.svdag -r 64 --layers file --colours --report layers.json
svdag build city.ply scan.ply -o layers.run -r 64 --layers file --part 1/2
svdag build red.obj -o red.svdag -r 8 --colours
svdag plan city.ply -o city.plan -r 64 --shards 2
svdag batch list.json --keep-going --report list.report.json
svdag batch list.json --keep-going --report list.report.json"""
LIST = [{"scene": "city.ply", "output": "a.svdag", "resolution": "64"},
        {"scene": "none.ply", "output": "b.svdag", "resolution": "64"}]
QUERIES = """svdag edit city.svdag -o coarse.svdag --level 5
svdag convert city.svdag -o small.svdag --layout compact
svdag pack city.svdag -o city.pack
svdag unpack city.pack -o unpacked.svdag
svdag export city.svdag -o city.npz
svdag export city.svdag -o distances.npz --level 5 --distance 4
svdag export city.svdag -o city.glb
svdag export red.svdag -o red.vox
svdag import city.npz -o back.svdag
svdag export city.svdag -o points.ply
svdag import points.ply -o points.svdag -r 64
svdag build city.ply -o dry.svdag -r 64 --dry-run
svdag info city.svdag
svdag info half.run
svdag run city.plan
svdag run city.plan --step merge-1
svdag info city.ply --parts
svdag info moving.gltf
svdag info layers.svdag --layers
svdag info layers.run
svdag-verify mesh layers.svdag city.ply scan.ply
svdag-verify diff layers.svdag layers.svdag
svdag-verify check city.svdag
svdag-verify mesh city.svdag city.ply --sample 1000
svdag-verify mesh solid.svdag scan.ply --sample 100
svdag-verify mesh city.svdag scan.ply --judge openvdb
svdag-verify colours red.svdag blue.obj
svdag-verify diff city.svdag thin.svdag
svdag-verify vdb city.svdag thin.vdb
svdag-verify trace city.svdag scan.ply --rays 1000
svdag-trace city.svdag --size 64x48 --samples 4 --rounds 1"""


def keys_of(value):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield key
            if key != "nearer":  # its keys are the bins of a histogram
                yield from keys_of(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from keys_of(inner)


class Reports(unittest.TestCase):
    def test_the_page_documents_exactly_the_printed_keys(self):
        with tempfile.TemporaryDirectory(prefix="svdag-reports-") as folder:
            folder = pathlib.Path(folder)
            (folder / "list.json").write_text(json.dumps(LIST))
            for name, colour in (("red", "1 0 0"), ("blue", "0 0 1")):
                (folder / f"{name}.obj").write_text("".join(f"v {at} {colour}\n" for at in ("0 0 0", "1 0 0", "0 1 0")) + "f 1 2 3\n")

            def run(line):
                program, *arguments = line.split()
                done = subprocess.run([BUILD / program, *arguments], cwd=folder, capture_output=True, text=True)
                self.assertIn(done.returncode, (0, 1, 3), line + "\n" + done.stderr)
                return done.stdout

            subprocess.run([sys.executable, "-B", ROOT / "tests/cli/moving_scene.py", "4"], cwd=folder, check=True)
            for line in BAKES.splitlines():
                run(line + " -q")
            texts = [(folder / name).read_text() for name in ("report.json", "layers.json", "list.report.json")]
            texts += [run(line + " --json") for line in QUERIES.splitlines()]
        printed = {key for text in texts for key in keys_of(json.loads(text))}
        rows = re.findall(r"^\| `.*", (ROOT / "docs" / "reports.md").read_text(), re.M)
        documented = set(re.findall(r"`([a-z][a-z0-9_]*)`", "\n".join(rows)))
        self.assertEqual(sorted(printed - documented), [], "printed, but not in docs/reports.md")
        self.assertEqual(sorted(documented - printed), [], "in docs/reports.md, but not printed")


if __name__ == "__main__":
    unittest.main()
