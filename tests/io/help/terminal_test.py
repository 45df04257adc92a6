#!/usr/bin/env python3
"""Tests that help and progress fit the terminal, and that pipes, NO_COLOR and dumb terminals get plain text.

PROGRAMS is the folder of the built programs.
"""
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import screen
import manuals

PROGRAMS = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
ENVIRONMENT = {k: v for k, v in os.environ.items() if k != "COLUMNS"}
NARROW = 20  # less than the name of the longest phase


def widest(text):
    return max(map(len, text.splitlines()))


def help_of(command):
    program, *rest = command.split()
    return [str(PROGRAMS / program), *rest, "--help"]


def piped(command, **environment):
    return subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT | environment)


def drawn(text):
    """The lines that were drawn over one another."""
    return [line for line in re.split(r"[\r\n]", text) if line.strip()]


class Help(unittest.TestCase):
    def test_fits_every_terminal_of_at_least_40_columns(self):
        for command in manuals.commands(PROGRAMS):
            for columns in (40, 57, 80, 100):
                code, text = screen.shown(help_of(command), columns)
                self.assertEqual(code, 0)
                self.assertLessEqual(widest(text), columns, f"{command} at {columns}:\n{text}")

    def test_topics_fit_too(self):
        for topic in ("grid", "rules", "layers", "colours", "memory", "farm", "formats", "exit-codes"):
            code, text = screen.shown([PROGRAMS / "svdag", "help", topic], 40)
            self.assertEqual(code, 0)
            self.assertLessEqual(widest(text), 40, text)

    def test_uses_the_width_of_the_terminal_up_to_a_readable_limit(self):
        self.assertGreater(widest(screen.shown(help_of("svdag build"), 100)[1]), 80)
        self.assertLessEqual(widest(screen.shown(help_of("svdag build"), 300)[1]), 100)

    def test_is_80_columns_wide_in_a_pipe_unless_COLUMNS_is_set(self):
        text = piped(help_of("svdag build")).stdout
        self.assertTrue(70 < widest(text) <= 80)
        self.assertLessEqual(widest(piped(help_of("svdag build"), COLUMNS="50").stdout), 50)
        self.assertEqual(piped(help_of("svdag build"), COLUMNS="7").stdout, piped(help_of("svdag build"), COLUMNS="40").stdout)
        self.assertEqual(piped(help_of("svdag build"), COLUMNS="many").stdout, text)

    def test_has_the_same_words_at_every_width(self):
        for command in manuals.commands(PROGRAMS):
            words = [piped(help_of(command), COLUMNS=columns).stdout.replace("\\\n", "").split() for columns in ("40", "100")]
            self.assertEqual(words[0], words[1], command)

    def test_broken_examples_can_be_pasted(self):
        text = piped([PROGRAMS / "svdag", "help", "farm"], COLUMNS="40").stdout
        self.assertIn("\\\n", text)
        self.assertIn("svdag plan city.glb -r 64K --shards 16 -m 4G -o city.plan", re.sub(r" \\\n +", " ", text))

    def test_a_closed_pipe_is_not_an_error(self):
        for command in ("svdag build", "svdag-verify", "svdag-trace"):
            reader, writer = os.pipe()
            os.close(reader)
            done = subprocess.run(help_of(command), stdout=writer, stderr=subprocess.PIPE)
            os.close(writer)
            self.assertEqual((done.returncode, done.stderr), (-signal.SIGPIPE, b""), command)
        done = subprocess.run(["bash", "-c", f"{PROGRAMS}/svdag build --help | head -1; echo ${{PIPESTATUS[0]}}"],
                              capture_output=True, text=True)
        self.assertRegex(done.stdout, r"^Bake scene files as one .svdag\n(0|141)\n$")
        self.assertEqual(done.stderr, "")


class Shown(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="svdag-terminal-")
        cls.at = pathlib.Path(cls.folder.name)
        subprocess.run([PROGRAMS / "svdag-scene", "city", "-n", "60K", "-q", "-o", "city.ply"], cwd=cls.at, check=True)
        cls.bake("-q")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def bake(cls, *options, columns=80, results=None, **environment):
        command = [PROGRAMS / "svdag", "build", "city.ply", "-o", "city.svdag", "-r", "2K", *options]
        return screen.shown(command, columns, environment, cls.at, results)

    def judge(self, columns, *options, **environment):
        command = [PROGRAMS / "svdag-verify", "mesh", "city.svdag", "city.ply", "--sample", "2000", *options]
        return screen.shown(command, columns, environment, self.at)

    def test_progress_never_wraps(self):
        for code, text in (self.bake(columns=40, results=subprocess.DEVNULL), self.judge(40, "-q")):
            self.assertEqual(code, 0, text)
            self.assertGreater(len(drawn(text)), 3, text)
            self.assertLess(max(map(len, drawn(text))), 40, text)

    def test_progress_shows_time_rate_and_memory_where_they_fit(self):
        # Enough work that a phase lasts more than a second, which a rate needs.
        command = [PROGRAMS / "svdag", "build", "city.ply", "-o", "long.svdag", "-r", "32K", "-j", "1", "-m", "1G"]
        for columns in (40, 60, 80, 120, 200):
            code, text = screen.shown(command, columns, {}, self.at, subprocess.DEVNULL)
            self.assertEqual(code, 0, text)
            lines = [line.rstrip() for line in drawn(text)]
            self.assertLess(max(map(len, lines)), columns, text)
            percents = [int(line.split("%")[0].split()[-1]) for line in lines]
            self.assertEqual(percents, sorted(percents), "one percentage for all phases")
            self.assertGreater(len(set(percents)), 10, text)
            times = r"  \d+:\d\d  about \d+:\d\d left"
            self.assertTrue(any(re.fullmatch(r"voxelize +\d+ %" + times + ".*", line) for line in lines), text)
            if columns >= 80:
                whole = r"voxelize +\d+ %" + times + r"  [\d.]+[kMG]? voxels/s  [\d.]+ [KMG]iB of 1 GiB"
                self.assertTrue(any(re.fullmatch(whole, line) for line in lines), text)

    def test_progress_is_truncated_to_the_width_of_the_terminal(self):
        code, text = self.judge(NARROW, "-q")
        self.assertEqual((code, max(map(len, drawn(text)))), (0, NARROW - 1), text)

    def test_progress_leaves_an_empty_line(self):
        _, text = self.judge(40, "-q")
        *_, erased, rest = text.split("\r")
        self.assertEqual((erased.strip(" "), rest), ("", ""))

    def test_there_is_no_progress_on_a_dumb_terminal_or_in_a_pipe(self):
        self.assertNotIn("\r", self.judge(80, TERM="dumb")[1])
        done = subprocess.run([PROGRAMS / "svdag-verify", "mesh", "city.svdag", "city.ply"], cwd=self.at, capture_output=True)
        self.assertNotIn(b"\r", done.stdout + done.stderr)
        self.assertIn("\r", self.judge(80)[1])

    def test_nothing_is_coloured(self):
        for environment in ({}, {"NO_COLOR": "1"}):
            for _, text in (self.bake("-v", **environment), self.judge(80, "-v", **environment),
                            screen.shown([PROGRAMS / "svdag", "build"], 80, environment)):
                self.assertNotIn("\x1b", text)

    def test_the_table_of_a_running_plan_never_wraps(self):
        subprocess.run([PROGRAMS / "svdag", "plan", "city.ply", "-r", "2K", "--shards", "4", "-o", "city.plan", "-q"],
                       cwd=self.at, check=True)
        code, text = screen.shown([PROGRAMS / "svdag", "run", "city.plan", "-j", "2"], 40, folder=self.at)
        self.assertEqual(code, 0, text)
        table = [line for line in re.sub(r"\x1b\[\d*[AK]", "", text).splitlines() if line.startswith("  ")]
        self.assertTrue(table, text)
        self.assertLess(max(map(len, table)), 40, text)
        self.assertIsNone(re.search(r"\x1b\[[\d;]*m", text))


if __name__ == "__main__":
    unittest.main()
