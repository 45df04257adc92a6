#!/usr/bin/env python3
"""Tests that truncating or overwriting a .svdag while a program reads it gives one message and no output.

svdag-trace reads the file into memory, the other programs map it."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import bakes

MESSAGES = ["can no longer be read: it was cut short, or its disk failed",  # a mapped page is missing
             "was changed while it was read",                                # zeros or other bytes were read
             "ends too early"]                                               # the read returned no bytes
BAD_INPUT = 3
TRIES = 20  # a program that ends before it is stopped is run again
# Commands that read the file for some time, and their outputs.
COMMANDS = {
    "check": (["svdag-verify", "check", "lost.svdag"], []),
    "diff": (["svdag-verify", "diff", "kept.svdag", "lost.svdag"], []),
    "export": (["svdag", "export", "lost.svdag", "--format", "ply", "-o", "points.ply"], ["points.ply"]),
    "render": (["svdag-verify", "render", "lost.svdag", "--size", "2048x2048", "-o", "picture.png"], ["picture.png"]),
    "trace": (["svdag-trace", "lost.svdag", "--size", "16x16", "--samples", "1", "--dump", "rays.bin"], ["rays.bin"]),
}


def truncate(lost, _):
    os.truncate(lost, 100)


def copy_over(lost, larger):
    lost.write_bytes(larger.read_bytes())  # truncates first, like ">" of a shell


def copy_into(lost, larger):
    with open(lost, "r+b") as file:  # overwrites checked nodes by others
        file.write(larger.read_bytes())


def maps(process, path):
    return str(path) in pathlib.Path(f"/proc/{process.pid}/maps").read_text()


def reads(process, path):
    """Whether the process has the file open and a part of it in memory."""
    words = pathlib.Path(f"/proc/{process.pid}/statm").read_text().split()
    return any(link.readlink() == path for link in pathlib.Path(f"/proc/{process.pid}/fd").iterdir()) \
        and int(words[1]) * os.sysconf("SC_PAGESIZE") > path.stat().st_size // 4


def stop_when(holds, process, path):
    """Stops the process while it holds the file; False if it ended before."""
    while process.poll() is None:
        try:
            held = holds(process, path)
        except OSError:  # the process ended or closed a file
            held = False
        if held:
            process.send_signal(signal.SIGSTOP)
            return True
        time.sleep(0.0005)
    return False


def run_and_damage(damage, folder, words, outputs):
    """(exit code, stderr) of a program whose file was changed; None if it finished before."""
    lost = folder / "lost.svdag"
    lost.write_bytes((folder / "kept.svdag").read_bytes())
    process = subprocess.Popen([bakes.BUILD / words[0], *words[1:]], cwd=folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    if stop_when(reads if words[0] == "svdag-trace" else maps, process, lost):
        damage(lost, folder / "larger.svdag")
        process.send_signal(signal.SIGCONT)
    text = process.communicate()[1]
    if process.returncode == 0:
        for output in outputs:
            (folder / output).unlink(missing_ok=True)
    return None if process.returncode == 0 else (process.returncode, text)


def failures(ended, left):
    if ended is None:
        return [f"never stopped in time in {TRIES} tries"]
    code, text = ended
    reported = code == BAD_INPUT and len(text.splitlines()) == 1 and any(s in text for s in MESSAGES)
    return [f"ended with {ended}"] * (not reported) + [f"{sorted(left)} remain"] * bool(left)


def main():
    report = bakes.Report()
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name).resolve()
        subprocess.run([bakes.BUILD / "svdag-scene", "hairball", "-n", "100K", "-q", "-o", "s.ply"], cwd=folder, check=True)
        for resolution, bake in (("2K", "kept.svdag"), ("4K", "larger.svdag")):
            subprocess.run([bakes.BUILD / "svdag", "build", "s.ply", "-r", resolution, "-q", "-o", bake], cwd=folder, check=True)
        for damage in (truncate, copy_over, copy_into):
            for case, (words, outputs) in COMMANDS.items():
                before = set(os.listdir(folder)) | {"lost.svdag"}
                tries = (run_and_damage(damage, folder, words, outputs) for _ in range(TRIES))
                ended = next((each for each in tries if each), None)
                report.record(f"{case}, {damage.__name__}", failures(ended, set(os.listdir(folder)) - before))
    report.finish()


if __name__ == "__main__":
    main()
