"""Runs the programs that come with the package. A program that fails is an Error with its sentence."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import threading
import warnings
from typing import Any, Callable, Mapping, Optional, Sequence, Union

from ._error import Error, error_of

Progress = Callable[[str, float], Any]
FOLDER = pathlib.Path(__file__).parent / "bin"


def program(name: str) -> str:
    path = FOLDER / name
    if not path.exists():
        raise Error(f"{path}: the program is missing from this package: install it with pip install or from a wheel", 2)
    return str(path)


def words_of(options: Mapping[str, Any]) -> list:
    """voxel_size=0.5 is --voxel-size=0.5; True is an option without a value; a tuple is joined by commas, a list repeats."""
    words = []
    for name, value in options.items():
        option = "--" + name.replace("_", "-")
        if getattr(value, "ndim", 0) > 0:
            raise TypeError(f"{name}: an array is not an option")
        for each in value if isinstance(value, list) else [value]:
            if each is None or each is False:
                continue
            if isinstance(each, tuple):
                each = ",".join(map(str, each))
            words.append(option if each is True else f"{option}={os.fspath(each) if isinstance(each, os.PathLike) else each}")
    return words


def read_progress(stream, progress: Optional[Progress]) -> str:
    """Reports "Phase  45 %" as progress("Phase", 0.45); returns all other lines."""
    messages, line = b"", b""
    while True:
        byte = stream.read1(4096)
        line += byte
        *whole, line = re.split(rb"[\r\n]", line) if byte else [line, b""]
        for text in whole:
            found = re.match(rb"\s*(\S.*?)\s+(\d+) %", text)
            if found and progress is not None:
                progress(found.group(1).decode(errors="replace"), int(found.group(2)) / 100)
            elif not found and text.strip():
                messages += text + b"\n"
        if not byte:
            return messages.decode(errors="replace")


def run(name: str, *arguments: Union[str, os.PathLike], progress: Optional[Progress] = None, accept: Sequence[int] = (0,)) -> str:
    """Standard output. Ctrl-C stops the program, which removes what it has begun."""
    command = [program(name), *map(os.fspath, arguments)]
    if progress is not None:
        command.append("--progress")
    # In a session of its own, so that the terminal's Ctrl-C reaches it once, from here.
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, stdin=subprocess.DEVNULL,
                          start_new_session=True) as process:
        out = []
        reader = threading.Thread(target=lambda: out.append(process.stdout.read()))
        reader.start()
        try:
            messages = read_progress(process.stderr, progress)
            process.wait()
        except BaseException:
            process.send_signal(signal.SIGINT)
            process.wait()
            raise
        finally:
            reader.join()
    if process.returncode not in accept:
        sentence = messages.strip().splitlines()[-1] if messages.strip() else f"{name} ended by signal {-process.returncode}"
        sentence = re.sub(r"^svdag[\w-]*: ", "", sentence)
        path = next((str(a) for a in arguments if sentence.startswith(f"{a}: ")), "")
        raise error_of(sentence, process.returncode, path)
    notes = re.findall(r"^svdag[\w-]*: (.*)", messages, re.M)  # what was left out, for example
    caller = 1
    while notes and sys._getframe(caller).f_globals.get("__package__") == __package__:
        caller += 1
    for note in notes:
        warnings.warn(note, stacklevel=caller + 1)
    return out[0].decode(errors="surrogateescape")


def run_json(name: str, *arguments: Union[str, os.PathLike], progress: Optional[Progress] = None,
             accept: Sequence[int] = (0,)) -> dict:
    return json.loads(run(name, *arguments, "--json", progress=progress, accept=accept))


def main() -> None:
    """The command lines svdag, svdag-verify and svdag-trace of the package."""
    path = program(pathlib.Path(sys.argv[0]).name)
    os.execv(path, [path, *sys.argv[1:]])
