#!/usr/bin/env python3
"""Golden command-line tests: what a person types, with the expected results below each command (the idea of cram).

A .t file holds the cases of one topic:

    ## name of a case
    # a comment
    $ svdag build scene.ply \\
    >   -r 64                    a command of several lines
    | exact line of stdout
    |* pattern of a line         as in the shell: * ? [
    |...                         any number of lines
    ! exact line of stderr       also !* and !...
    ? 2                          the exit code; 0 without this line

A case is one shell script. It runs in an empty folder with the built programs, and those of tests, on PATH; $TESTS is this folder. Each
command runs under `set -e`, except where a nonzero exit code is expected. A command that fails unexpectedly ends its case.

--update records the current results in the files. It never changes a stream that has a pattern.
"""
import argparse
import collections
import difflib
import fnmatch
import os
import pathlib
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace

HERE = pathlib.Path(__file__).resolve().parent
TIMEOUT = 300
NO_NEWLINE = "\\ No newline at end of output"
# The script prints these after each command: the exit code to stdout, an end to stderr.
END = "end_() { printf '\\036%d\\036' $1; printf '\\036' >&2; }\n"


@dataclass
class Command:
    head: list = field(default_factory=list)  # the comments and empty lines before it
    text: list = field(default_factory=list)
    out: list = field(default_factory=list)  # lines as in the file, without the first character
    err: list = field(default_factory=list)
    code: int = 0

    def lines(self):
        typed = [f"{sign} {line}".rstrip() for sign, line in zip("$" + ">" * len(self.text), self.text)]
        code = [f"? {self.code}"] if self.code else []
        return self.head + typed + ["|" + line for line in self.out] + ["!" + line for line in self.err] + code


@dataclass
class Case:
    path: pathlib.Path
    name: str
    commands: list
    tail: list  # the comments and empty lines after the last command

    def lines(self):
        return [f"## {self.name}"] + [line for command in self.commands for line in command.lines()] + self.tail

    def script(self):
        def run(command):
            text = "\n".join(command.text)
            return f"{{\n{text}\n}} && end_ 0 || end_ $?\n" if command.code else f"{text}\nend_ $?\n"
        return END + "".join(map(run, self.commands))


def parse(path):
    """The lines before the first case of a file, and its cases."""
    top, cases = [], []
    for number, line in enumerate(path.read_text().split("\n")[:-1], 1):
        if line.startswith("## "):
            cases.append(Case(path, line[3:].strip(), [], []))
            continue
        if not cases:
            top.append(line)
            continue
        case, sign, rest = cases[-1], line[:1], line[1:]
        if sign == "$":
            case.commands.append(Command(case.tail, [rest[1:]]))
            case.tail = []
        elif sign in ("", "#"):
            case.tail.append(line)
        elif sign not in ">|!?" or not case.commands or case.tail:
            sys.exit(f"{path.name}:{number}: not a line of a case, or out of place: {line}")
        elif sign == ">":
            case.commands[-1].text.append(rest[1:])
        elif sign == "?":
            case.commands[-1].code = int(rest)
        else:
            (case.commands[-1].out if sign == "|" else case.commands[-1].err).append(rest)
    return top, cases


def run_script(script, programs):
    environment = {k: v for k, v in os.environ.items() if k != "COLUMNS"}  # without it, help is wrapped at 80 columns
    environment |= dict(PATH=f"{programs}:/usr/bin:/bin:{programs}/tests", LC_ALL="C", TESTS=str(HERE))
    with tempfile.TemporaryDirectory(prefix="svdag-cli-") as folder, tempfile.NamedTemporaryFile("w") as file:
        file.write(script)
        file.flush()
        try:
            done = subprocess.run(["sh", "-e", file.name], cwd=folder, env=environment, timeout=TIMEOUT,
                                  stdin=subprocess.DEVNULL, capture_output=True)
        except subprocess.TimeoutExpired as timeout:
            return 124, (timeout.stdout or b"").decode(errors="replace"), f"timed out after {TIMEOUT} s\n"
    return done.returncode, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace")


def written(text):
    """The lines of a file for this output."""
    lines = [f" {line}" if line else "" for line in text.split("\n")]
    return lines[:-1] if not lines[-1] else lines + [NO_NEWLINE]


def is_pattern(line):
    return line[:1] == "*" or line == "..."


def matches(expected, lines):
    """Whether the lines of a file `expected` match `lines`."""
    if not expected:
        return not lines
    first, rest = expected[0], expected[1:]
    if first == "...":
        return any(matches(rest, lines[i:]) for i in range(len(lines) + 1))
    if not lines:
        return False
    same = fnmatch.fnmatchcase(lines[0], first[1:]) if is_pattern(first) else first == lines[0]
    return same and matches(rest, lines[1:])


def run(case, programs):
    """The case with the real results where they differ from the expected ones, and the number of commands that ran."""
    status, out, err = run_script(case.script(), programs)
    parts = re.split("\036(\\d+)\036", out)
    outs, codes, errs = parts[::2], [int(code) for code in parts[1::2]], err.split("\036")
    ran = min(len(codes) + 1, len(case.commands))
    codes.append(status)  # of the command that ended the script
    commands = []
    for command, out, err, code in zip(case.commands, outs, errs + [""], codes):
        out, err = written(out), written(err)
        commands.append(replace(command, out=command.out if matches(command.out, out) else out,
                                err=command.err if matches(command.err, err) else err, code=code))
    return replace(case, commands=commands + case.commands[ran:]), ran


def update(case, programs):
    """The case with the results of a run, except streams with patterns."""
    for _ in case.commands:
        found, ran = run(case, programs)
        if ran == len(case.commands) or found.commands[ran - 1].code == case.commands[ran - 1].code:
            break
        case.commands[ran - 1].code = found.commands[ran - 1].code  # it ended the script: run again, with this expected
    for old, new in zip(case.commands, found.commands):
        new.out = old.out if any(map(is_pattern, old.out)) else new.out
        new.err = old.err if any(map(is_pattern, old.err)) else new.err
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", required=True, type=pathlib.Path, help="folder of the built programs")
    parser.add_argument("--update", action="store_true", help="record the current results")
    parser.add_argument("names", nargs="*", help="only these cases, or files such as build.t (default: all)")
    options = parser.parse_args()
    programs = options.programs.resolve()
    files = {path: parse(path) for path in sorted(HERE.glob("*.t"))}
    chosen = [case for _, cases in files.values() for case in cases
              if not options.names or {case.name, case.path.name} & set(options.names)]
    if not chosen:
        sys.exit("no case or file has one of these names")
    for name, count in collections.Counter(case.name for _, cases in files.values() for case in cases).items():
        if count > 1:
            sys.exit(f"{count} cases are named {name}")
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        if options.update:
            updated = {case.name: case for case in pool.map(lambda case: update(case, programs), chosen)}
            for path, (top, cases) in files.items():
                lines = top + [line for case in cases for line in updated.get(case.name, case).lines()]
                path.write_text("\n".join(lines) + "\n")
            chosen = [updated[case.name] for case in chosen]
        runs = list(pool.map(lambda case: run(case, programs), chosen))
    failed = 0
    for case, (found, ran) in zip(chosen, runs):
        differences = list(difflib.unified_diff(case.lines(), found.lines(), "expected", "found", lineterm=""))
        if ran < len(case.commands):
            differences.append("the case ended after: " + " ".join(case.commands[ran - 1].text))
        if differences:
            failed += 1
            print(f"FAILED {case.path.name}: {case.name}\n" + "\n".join(differences) + "\n")
    print(f"{len(chosen) - failed} passed, {failed} failed, 0 skipped")
    return failed > 0


if __name__ == "__main__":
    sys.exit(main())
