#!/usr/bin/env python3
"""Tests the completion of commands, options, named values and files by extension in bash, fish and zsh.

The scripts run in the shells themselves; a shell that is not installed is skipped. BUILD is the folder of a finished
build.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import screen
import manuals

BUILD = pathlib.Path(sys.argv.pop(1) if len(sys.argv) > 1 else "build/release").resolve()
SHARE = BUILD / "share"
FILES = ["city.ply", "city.svdag", "hall.GLB", "notes.txt", "points.vdb", "report.json"]

# A typed line, and all suggestions for its last word.
OFFERS = [
    ("svdag bu", {"build"}),
    ("svdag i", {"info", "import"}),
    ("svdag help ru", {"run", "rules"}),
    ("svdag help exit", {"exit-codes"}),
    ("svdag build --resol", {"--resolution"}),
    ("svdag build city.ply --rule ", {"conservative", "thin", "solid"}),
    ("svdag build city.ply --rule t", {"thin"}),
    ("svdag build ", {"city.ply", "hall.GLB", "folder/"}),
    ("svdag build -r 4K ci", {"city.ply"}),
    ("svdag build city.ply -o ", {"city.svdag", "folder/"}),
    ("svdag run ", {"folder/"}),
    ("svdag submit folder --engine ", {"slurm", "openjd"}),
    ("svdag export city.svdag --format hash", {"hashdag"}),
    ("svdag export city.svdag -o no", {"notes.txt"}),
    ("svdag import p", {"points.vdb"}),
    ("svdag import --format bin", {"binvox"}),
    ("svdag-verify re", {"render", "report"}),
    ("svdag-verify mesh ", {"city.svdag", "folder/"}),
    ("svdag-verify mesh city.svdag --judge ", {"integer", "cgal", "openvdb"}),
    ("svdag-verify render city.svdag --mode s", {"shadow", "soft", "steps"}),
    ("svdag-verify render city.svdag --preset in", {"inside"}),
    ("svdag-verify check --judge", set()),
    ("svdag-trace --device cu", {"cuda"}),
    ("svdag-trace ", {"city.svdag", "folder/"}),
]

# A typed line, and the line after TAB.
LINES = [("svdag bui", "svdag build "), ("svdag build --resol", "svdag build --resolution"),
         ("svdag build --rule th", "svdag build --rule thin"), ("svdag build --rule=th", "svdag build --rule=thin"),
         ("svdag-verify mesh ci", "svdag-verify mesh city.svdag "),
         ("svdag-verify mesh city.svdag ci", "svdag-verify mesh city.svdag city.ply"),
         ("svdag-trace --device cu", "svdag-trace --device cuda"), ("svdag help mem", "svdag help memory"),
         ("svdag export -o=no --format=np", "svdag export -o=no --format=npz")]


class Shell(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if cls.program is None:
            raise unittest.SkipTest("no shell of its own")
        if not shutil.which(cls.program):
            print(f"{cls.program} is not installed")
            raise unittest.SkipTest(f"{cls.program} is not installed")
        cls.temp_folder = tempfile.TemporaryDirectory(prefix="svdag-completion-")
        cls.folder = pathlib.Path(cls.temp_folder.name) / "work"
        (cls.folder / "folder").mkdir(parents=True)
        for name in FILES:
            (cls.folder / name).touch()
        cls.commands = manuals.commands(BUILD)
        cls.environment = dict(os.environ, HOME=cls.temp_folder.name, PATH=f"{BUILD}:/usr/bin:/bin", LC_ALL="C.UTF-8")

    @classmethod
    def tearDownClass(cls):
        cls.temp_folder.cleanup()

    program = None

    def run_shell(self, script, *arguments):
        done = subprocess.run([self.program, *arguments, "-c", script], cwd=self.folder, env=self.environment,
                              capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""), script)
        return set(done.stdout.splitlines())

    def check_offers(self, otherwise=()):
        for line, expected in (dict(OFFERS) | dict(otherwise)).items():
            self.assertEqual(self.offers(line), expected, line)

    def check_options(self):
        for command in self.commands.values():
            self.assertEqual(self.offers(f"{command.name} --"), {n for n in command.names() if n.startswith("--")},
                             command.name)

    def check_lines(self, setup, prompt):
        shell = screen.Screen(self.interactive, 200, self.environment | {"TERM": "xterm"}, self.folder)
        try:
            shell.write(setup)
            self.assertTrue(shell.wait_for(prompt), shell.seen)
            for line, expected in LINES + [(f"{name} --hel", f"{name} --help") for name in self.commands]:
                shell.write("\x15" + line)  # ^U clears the line
                shell.write("\t")
                self.assertTrue(shell.wait_for(expected.encode()), f"{line}: {shell.seen[-400:]}")
        finally:
            shell.close()


class Bash(Shell):
    program = "bash"
    interactive = ["bash", "--norc", "--noprofile", "-i"]

    def offers(self, line):
        words = line.split(" ")
        script = SHARE / "bash-completion" / "completions" / words[0]
        found = self.run_shell(f"""
            source {script}
            COMP_WORDS=({' '.join(w or '""' for w in words)}) COMP_CWORD={len(words) - 1}
            function=$(complete -p {words[0]} | sed 's/.* -F \\([^ ]*\\) .*/\\1/')
            $function
            printf '%s\\n' "${{COMPREPLY[@]}}" """)
        return {f"{name}/" if (self.folder / name).is_dir() else name for name in found if name}

    def test_offers(self):
        self.check_offers({"svdag export -o = ": set(), "svdag export -o = no": set(), "svdag export -o =": set(),
                           "svdag export --output = no": {"notes.txt"}, "svdag build --rule =": {"conservative", "thin", "solid"}})

    def test_offers_every_option_and_no_other(self):
        self.check_options()

    def test_completes_a_line_as_it_is_typed(self):
        sources = "; ".join(f"source {p}" for p in sorted((SHARE / "bash-completion" / "completions").iterdir()))
        self.check_lines(f"{sources}; bind 'set bell-style none'; PS1='re''ady> '\n", b"ready> ")


class Fish(Shell):
    program = "fish"

    def offers(self, line):
        script = SHARE / "fish" / "vendor_completions.d" / f"{line.split()[0]}.fish"
        return {offer.split("\t")[0] for offer in self.run_shell(f"source {script}; complete -C '{line}'", "--no-config")}

    def test_offers(self):
        # The script does not count arguments: each may be any of them.
        self.check_offers({"svdag-verify mesh ": {"city.svdag", "city.ply", "hall.GLB", "folder/"},
                           "svdag build --output=": {"--output=city.svdag", "--output=folder/"},
                           "svdag build --output=ci": {"--output=city.svdag"}, "svdag build --cache=": {"--cache=folder/"}})

    def test_offers_every_option_and_no_other(self):
        self.check_options()


class Zsh(Shell):
    program = "zsh"
    interactive = ["zsh", "-f", "-i"]
    script = SHARE / "zsh" / "site-functions" / "_svdag"

    def test_the_script_is_valid(self):
        self.run_shell(f"zsh -n {self.script}", "-f")

    def test_is_found_by_the_names_of_the_programs(self):
        found = self.run_shell(f"fpath=({self.script.parent} $fpath); autoload -U compinit; compinit -u -D; "
                               "print -l ${_comps[svdag]} ${_comps[svdag-verify]} ${_comps[svdag-trace]}", "-f")
        self.assertEqual(found, {"_svdag"})

    def test_completes_a_line_as_it_is_typed(self):
        self.check_lines(f"fpath=({self.script.parent} $fpath); autoload -U compinit; compinit -u -D; unsetopt beep; "
                         "PROMPT='re''ady> '\n", b"ready> ")


if __name__ == "__main__":
    unittest.main()
