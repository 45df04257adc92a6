#!/usr/bin/env python3
"""Tests that man pages document exactly the options of the programs, and that man(1) shows them without warnings.

BUILD is the folder of a finished build. Without man-db, the test only checks that the pages exist.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import manuals

BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
MAN = BUILD / "share" / "man"
TOPICS = pathlib.Path(__file__).resolve().parents[3] / "builder" / "commands" / "topics"


def read(page):
    """(the page as man shows it, its warnings), with lines too long to be broken."""
    done = subprocess.run(["man", "--warnings", "-E", "UTF-8", "-l", page], capture_output=True, text=True,
                          env=dict(os.environ, MANWIDTH="1000", LC_ALL="C.UTF-8"))
    return done.stdout, done.stderr


class Pages(unittest.TestCase):
    def setUp(self):
        self.commands = manuals.commands(BUILD)

    def test_every_command_and_topic_has_a_page(self):
        self.assertEqual(sorted(p.name for p in (MAN / "man1").iterdir()),
                         sorted(f"{c.page()}.1" for c in self.commands.values()))
        self.assertEqual(sorted(p.name for p in (MAN / "man7").iterdir()),
                         sorted(f"svdag-{p.stem}.7" for p in TOPICS.glob("*.txt")))

    def test_references_between_pages_are_valid(self):
        for page in MAN.rglob("*.[17]"):
            others = re.findall(r"^\.BR (\S+) \((\d)\)", page.read_text(), re.M)
            self.assertGreater(len(others), 5, page.name)
            for name, section in others:
                name = name.replace("\\-", "-")
                self.assertTrue((MAN / f"man{section}" / f"{name}.{section}").exists(), f"{page.name}: {name}")


@unittest.skipUnless(shutil.which("man"), "man-db is not installed")
class Rendered(unittest.TestCase):
    def test_man_gives_no_warning(self):
        for page in sorted(MAN.rglob("*.[17]")):
            text, warnings = read(page)
            self.assertEqual(warnings, "", page.name)
            self.assertIn("SEE ALSO", text, page.name)

    def test_a_broken_page_gives_a_warning(self):
        broken = BUILD / "share" / "broken.1"
        broken.write_text(".TH BROKEN 1\n.SH NAME\n\\fZbroken\\fR\n.NOSUCH\n")
        self.assertNotEqual(read(broken)[1], "")
        broken.unlink()

    def test_pages_and_help_name_the_same_options(self):
        for command in manuals.commands(BUILD).values():
            shown = subprocess.run([BUILD / command.name.split()[0], *command.name.split()[1:], "--help"], check=True,
                                   capture_output=True, text=True).stdout
            in_help = {n for line in shown.splitlines() if line[:3] == "  -" for n in manuals.options_in(line.strip())}
            page = MAN / "man1" / f"{command.page()}.1"
            in_page = {n for line in read(page)[0].splitlines() if line[:8] == "       -" for n in manuals.options_in(line.strip())}
            self.assertEqual(in_page, in_help, command.name)
            self.assertGreaterEqual(len(in_help), 2, command.name)

    def test_texts_of_options_and_examples_are_in_the_page(self):
        for command in manuals.commands(BUILD).values():
            text = read(MAN / "man1" / f"{command.page()}.1")[0]
            squeezed = " ".join(text.split())
            for option in command.options + command.operands:
                self.assertIn(" ".join(option.text.split()), squeezed, command.name)
            for line in command.notes:
                if line.startswith("  svdag"):
                    self.assertIn(line.strip(), text, command.name)

    def test_topics_are_complete(self):
        for topic in TOPICS.glob("*.txt"):
            squeezed = " ".join(read(MAN / "man7" / f"svdag-{topic.stem}.7")[0].split())
            for line in topic.read_text().splitlines()[1:]:
                self.assertIn(" ".join(line.split()), squeezed, topic.name)


if __name__ == "__main__":
    unittest.main()
