#!/usr/bin/env python3
"""A .svdag that is cut short while a program reads it ends that program with a sentence and no output."""
import os
import pathlib
import signal
import subprocess
import tempfile
import time

import bakes

SENTENCES = ["can no longer be read: it was cut short, or its disk failed",  # a page was lost
             "was changed while it was read"]                                # the rest of a page was read as zeros
BAD_INPUT = 3
TRIES = 20  # a program that has ended before it was stopped is asked again
# Programs that walk the file for a while, and what they would leave.
COMMANDS = {
    "check": (["svdag-verify", "check", "lost.svdag"], []),
    "diff": (["svdag-verify", "diff", "kept.svdag", "lost.svdag"], []),
    "export": (["svdag", "export", "lost.svdag", "--format", "ply", "-o", "points.ply"], ["points.ply"]),
    "render": (["svdag-verify", "render", "lost.svdag", "--size", "2048x2048", "-o", "picture.png"], ["picture.png"]),
}


def maps(process, path):
    try:
        return str(path) in pathlib.Path(f"/proc/{process.pid}/maps").read_text()
    except OSError:
        return False


def stop_when_mapped(process, path):
    """True if the process was stopped, and has still work to do, with the file mapped."""
    while process.poll() is None:
        if maps(process, path):
            process.send_signal(signal.SIGSTOP)
            return True
        time.sleep(0.0005)
    return False


def run_and_cut(folder, kept, words, outputs):
    """The exit code and standard error of a program whose file loses its pages; None if it was faster."""
    lost = folder / "lost.svdag"
    lost.write_bytes(kept.read_bytes())
    process = subprocess.Popen([bakes.BUILD / words[0], *words[1:]], cwd=folder, stdout=subprocess.DEVNULL,
                               stderr=subprocess.PIPE, text=True)
    if stop_when_mapped(process, lost):
        os.truncate(lost, 100)
        process.send_signal(signal.SIGCONT)
    text = process.communicate()[1]
    if process.returncode == 0:
        for output in outputs:
            (folder / output).unlink(missing_ok=True)
    return None if process.returncode == 0 else (process.returncode, text)


def main():
    report = bakes.Report()
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name).resolve()
        kept = folder / "kept.svdag"
        subprocess.run([bakes.BUILD / "svdag-scene", "hairball", "-n", "100K", "-q", "-o", "s.ply"], cwd=folder, check=True)
        subprocess.run([bakes.BUILD / "svdag", "build", "s.ply", "-r", "2K", "-q", "-o", kept], cwd=folder, check=True)
        for case, (words, outputs) in COMMANDS.items():
            before = set(os.listdir(folder)) | {"lost.svdag"}
            ended = next((e for e in (run_and_cut(folder, kept, words, outputs) for _ in range(TRIES)) if e), None)
            left = set(os.listdir(folder)) - before
            report.judge(case, [f"never caught in {TRIES} tries"] * (ended is None) +
                         [f"ended with {ended}"] * (ended is not None and
                                                    (ended[0] != BAD_INPUT or not any(s in ended[1] for s in SENTENCES)
                                                     or len(ended[1].splitlines()) != 1)) +
                         [f"left {sorted(left)}"] * bool(left))
    report.finish()


if __name__ == "__main__":
    main()
