#!/usr/bin/env python3
"""Fails on a shell script that its shell cannot parse: most run in `make stress` alone, where a slip waits long.

The scripts of tests/cli are run by the command line tier, not on their own.
"""
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHELLS = {"#!/bin/sh": "sh", "#!/bin/bash": "bash"}


def scripts():
    folders = (folder for folder in ROOT.iterdir() if folder.name not in ("build", ".git"))
    found = [path for folder in folders if folder.is_dir() for path in folder.rglob("*.sh")]
    return [path for path in found if path.parent != ROOT / "tests/cli"]


class ShellScripts(unittest.TestCase):
    def test_each_is_parsed_by_the_shell_that_it_names(self):
        self.assertGreaterEqual(len(scripts()), 5)
        for path in scripts():
            with self.subTest(str(path.relative_to(ROOT))):
                shell = SHELLS.get(path.read_text().split("\n", 1)[0])
                self.assertIsNotNone(shell, "its first line names no shell")
                parsed = subprocess.run([shell, "-n", str(path)], capture_output=True, text=True)
                self.assertEqual((parsed.returncode, parsed.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
