#!/usr/bin/env python3
"""Tests that every example in the help parses: in an empty folder it fails because of missing files, not of usage.

The examples are those of --help and of the topics. PROGRAMS is the folder of the built programs.
"""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parent), str(pathlib.Path(__file__).resolve().parents[1] / "formats")]
import manuals
import write_points

PROGRAMS = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
TOPICS = pathlib.Path(__file__).resolve().parents[3] / "builder" / "commands" / "topics"
USAGE, MISSING = 2, {3, 4}  # a missing scene, or a missing scratch folder


def run(line):
    with tempfile.TemporaryDirectory(prefix="svdag-example-") as folder:
        return subprocess.run(shlex.split(line.split(" < ")[0]), cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True,
                              env=dict(os.environ, PATH=f"{PROGRAMS}:/usr/bin:/bin"))


class Examples(unittest.TestCase):
    def check(self, lines, min_count):
        self.assertGreaterEqual(len(lines), min_count)
        for line in lines:
            done = run(line)
            expected = {0} if " help " in line else MISSING
            if "city.plan is not a plan folder" in done.stderr:  # a shard of a missing plan
                expected = {USAGE}
            self.assertIn(done.returncode, expected, f"{line}: {done.stderr}")

    def test_of_help(self):
        self.check([line.strip() for command in manuals.commands(PROGRAMS).values() for line in command.notes
                    if line.startswith("  svdag")], 25)

    def test_of_topics(self):
        for topic in sorted(TOPICS.glob("*.txt")):
            with self.subTest(topic.name):
                self.check([line.strip() for line in topic.read_text().splitlines() if line.startswith("    svdag")], 4)

    def test_every_command_has_one(self):
        for command in manuals.commands(PROGRAMS).values():
            if command.name != "svdag help":
                self.assertTrue(any(line.startswith(f"  {command.name} ") for line in command.notes), command.name)

    def test_an_invalid_example_is_found(self):
        self.assertEqual(run("svdag build city.glb -o city.svdag --rule thick").returncode, USAGE)


# A command line for each command that has options with named values, in a folder with a small scene and its DAG, but
# without a plan, so that none is submitted to a farm.
LINES = {"svdag build": "city.ply -o other.svdag -r 64", "svdag batch": "city.list -r 64",
         "svdag plan": "city.ply -o other.plan -r 64 --shards 2",
         "svdag info": "city.ply", "svdag merge": "a.run -o merged.svdag", "svdag edit": "city.svdag -o edited.svdag --level 4",
         "svdag pack": "city.svdag -o city.pack", "svdag unpack": "city.pack -o unpacked.svdag",
         "svdag colour": "city.svdag city.ply -o painted.svdag",
         "svdag convert": "city.svdag -o converted.svdag", "svdag submit": "missing.plan", "svdag export": "city.svdag -o out.vdb", "svdag import": "city.npz -o in.svdag",
         "svdag-verify mesh": "city.svdag city.ply", "svdag-verify render": "city.svdag -o city.png --size 16x16",
         "svdag-verify report": "city.svdag city.json -o city.html --size 16x16",
         "svdag-verify view": "city.svdag --to page",
         "svdag-trace": "city.svdag --size 16x16 --samples 1 --rounds 1"}
# Of options of one format.
LINES_WITH = {("svdag export", "--up"): "city.svdag -o out.vox", ("svdag import", "--up"): "city.vox -o in.svdag",
              ("svdag import", "--layers"): "tile.las -o in.svdag -s 1",
              ("svdag export", "--max-quads"): "city.svdag -o out.glb", ("svdag export", "--no-merge"): "city.svdag -o out.glb"}
BY_MACHINE = ["--vectors"]  # the values depend on the processor


class Choices(unittest.TestCase):
    """Tests that the values that completion offers are those that the program accepts."""

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="svdag-choices-")
        for line in ("svdag-scene city -n 2K -q -o city.ply", "svdag build city.ply -q -o city.svdag -r 64 --report city.json",
                     "svdag export city.svdag -q -o city.npz", "svdag export city.svdag -q -o city.vox"):
            assert cls.run_line(line).returncode == 0, line
        (pathlib.Path(cls.folder.name) / "tile.las").write_bytes(write_points.las([[1, 2, 3]], [0.01] * 3, [0] * 3))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def run_line(cls, line):
        return subprocess.run(line.split(), cwd=cls.folder.name, capture_output=True, text=True,
                              env=dict(os.environ, PATH=f"{PROGRAMS}:/usr/bin:/bin"))

    def refused(self, command, option, value):
        line = LINES_WITH.get((command, option.names[-1]), LINES[command])
        done = self.run_line(f"{command} {line} {option.names[-1]} {value}")
        return done.returncode == USAGE and f"{option.names[-1]}: " in done.stderr

    def test_exactly_the_offered_values_are_accepted(self):
        tested = 0
        for command in manuals.commands(PROGRAMS).values():
            for option in command.options:
                if not option.choices or option.names[-1] in BY_MACHINE:
                    continue
                self.assertTrue(self.refused(command.name, option, "nonsense"), f"{command.name} {option.names}")
                for value in option.choices:
                    self.assertFalse(self.refused(command.name, option, value), f"{command.name} {option.names} {value}")
                    self.assertIn(value, option.text, command.name)
                    tested += 1
        self.assertGreater(tested, 40)


class Topics(unittest.TestCase):
    def test_fit_a_page_of_a_terminal(self):
        for topic in TOPICS.glob("*.txt"):
            lines = topic.read_text().splitlines()
            self.assertTrue(lines[0].startswith(f"{topic.stem}: "), topic.name)
            self.assertLessEqual(max(map(len, lines)), 80, topic.name)
            self.assertTrue(20 <= len(lines) <= 45, f"{topic.name}: {len(lines)} lines")

    def test_are_shown_as_written(self):
        for topic in TOPICS.glob("*.txt"):
            shown = run(f"svdag help {topic.stem}").stdout
            self.assertEqual(shown.split(), topic.read_text().split())
            self.assertEqual([line for line in shown.splitlines() if line.startswith("    ")],
                             [line for line in topic.read_text().splitlines() if line.startswith("    ")])


if __name__ == "__main__":
    unittest.main()
