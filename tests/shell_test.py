#!/usr/bin/env python3
"""Tests that every shell script parses; most of them run only in `make stress`, which would find an error late."""
import pathlib
import subprocess
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHELLS = {"#!/bin/sh": "sh", "#!/bin/bash": "bash"}


def scripts():
    folders = (folder for folder in ROOT.iterdir() if folder.name not in ("build", ".git"))
    return [path for folder in folders if folder.is_dir() for path in folder.rglob("*.sh")]


class ShellScripts(unittest.TestCase):
    def test_each_script_parses_with_its_shell(self):
        self.assertGreaterEqual(len(scripts()), 5)
        for path in scripts():
            with self.subTest(str(path.relative_to(ROOT))):
                shell = SHELLS.get(path.read_text().split("\n", 1)[0])
                self.assertIsNotNone(shell, "the first line is not #!/bin/sh or #!/bin/bash")
                parsed = subprocess.run([shell, "-n", str(path)], capture_output=True, text=True)
                self.assertEqual((parsed.returncode, parsed.stderr), (0, ""))


if __name__ == "__main__":
    unittest.main()
