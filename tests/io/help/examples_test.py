#!/usr/bin/env python3
"""Every command line that the help shows can be meant: in an empty folder it fails for want of its files, never as usage.

Examples are those of --help and of the topics. PROGRAMS is the folder of the built programs.
"""
import os
import pathlib
import shlex
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import told

PROGRAMS = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
TOPICS = pathlib.Path(__file__).resolve().parents[3] / "builder" / "commands" / "topics"
USAGE, MISSING = 2, {3, 4}  # a scene, or a folder for what is spilled


def run(line):
    with tempfile.TemporaryDirectory(prefix="svdag-example-") as folder:
        return subprocess.run(shlex.split(line), cwd=folder, capture_output=True, text=True,
                              env=dict(os.environ, PATH=f"{PROGRAMS}:/usr/bin:/bin"))


class Examples(unittest.TestCase):
    def check(self, lines, least):
        self.assertGreaterEqual(len(lines), least)
        for line in lines:
            done = run(line)
            wanted = {0} if " help " in line else MISSING
            if "city.plan is none: svdag plan makes one" in done.stderr:  # a shard of a plan that is missing
                wanted = {USAGE}
            self.assertIn(done.returncode, wanted, f"{line}: {done.stderr}")

    def test_of_help(self):
        self.check([line.strip() for command in told.commands(PROGRAMS).values() for line in command.notes
                    if line.startswith("  svdag")], 25)

    def test_of_topics(self):
        for topic in sorted(TOPICS.glob("*.txt")):
            with self.subTest(topic.name):
                self.check([line.strip() for line in topic.read_text().splitlines() if line.startswith("    svdag")], 4)

    def test_every_command_has_one(self):
        for command in told.commands(PROGRAMS).values():
            if command.name != "svdag help":
                self.assertTrue(any(line.startswith(f"  {command.name} ") for line in command.notes), command.name)

    def test_one_that_cannot_be_meant_is_found(self):
        self.assertEqual(run("svdag build city.glb -o city.svdag --rule thick").returncode, USAGE)


class Topics(unittest.TestCase):
    def test_fit_a_page_of_a_terminal(self):
        for topic in TOPICS.glob("*.txt"):
            lines = topic.read_text().splitlines()
            self.assertTrue(lines[0].startswith(f"{topic.stem}: "), topic.name)
            self.assertLessEqual(max(map(len, lines)), 80, topic.name)
            self.assertTrue(20 <= len(lines) <= 45, f"{topic.name}: {len(lines)} lines")

    def test_are_shown_as_they_were_written(self):
        for topic in TOPICS.glob("*.txt"):
            shown = run(f"svdag help {topic.stem}").stdout
            self.assertEqual(shown.split(), topic.read_text().split())
            self.assertEqual([line for line in shown.splitlines() if line.startswith("    ")],
                             [line for line in topic.read_text().splitlines() if line.startswith("    ")])


if __name__ == "__main__":
    unittest.main()
