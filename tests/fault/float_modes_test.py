#!/usr/bin/env python3
"""Tests that a library that sets another rounding mode and flushes denormals does not affect bakes and verdicts."""
import os
import pathlib
import random
import subprocess
import tempfile

import bakes

MODIFIED = dict(os.environ, LD_PRELOAD=str(bakes.BUILD / "tests/libsvdag_float_modes.so"))
SCENES = {"denormals": 2e-306, "ordinary": 7.3}  # their sizes; the voxel size of the first is barely a normal number


def write_scene(path, size):
    chance = random.Random(3)
    lines = [f"v {' '.join(repr(chance.random() * size) for _ in range(3))}\n" for _ in range(120)]
    path.write_text("".join(lines) + "".join(f"f {i} {i + 1} {i + 2}\n" for i in range(1, 120, 3)))


def bake_and_verify(folder, environment, output, scene):
    """(the bytes of the bake, the messages of the commands)"""
    def run(program, *words):
        done = subprocess.run([bakes.BUILD / program, *words], cwd=folder, env=environment, capture_output=True, text=True)
        return f"{program} {words[0]}: exit {done.returncode} {done.stdout}{done.stderr}".replace(output, "OUTPUT")
    texts = [run("svdag", "build", scene, "-r", "64", "-q", "-j", "2", "-o", output),
             run("svdag-verify", "check", output), run("svdag-verify", "mesh", output, scene)]
    return (folder / output).read_bytes() if (folder / output).exists() else b"", texts


def main():
    report = bakes.Report()
    with tempfile.TemporaryDirectory(prefix="svdag-fault-") as name:
        folder = pathlib.Path(name).resolve()
        for scene, size in SCENES.items():
            write_scene(folder / f"{scene}.obj", size)
            data, texts = bake_and_verify(folder, os.environ, "plain.svdag", f"{scene}.obj")
            report.record(f"{scene}: default modes", [text for text in texts if "exit 0" not in text])
            modified, modified_texts = bake_and_verify(folder, MODIFIED, "modified.svdag", f"{scene}.obj")
            report.record(f"{scene}: other modes", ["the bytes differ"] * (modified != data) +
                         [f"{b!r} instead of {a!r}" for a, b in zip(texts, modified_texts) if a != b])
    report.finish()


if __name__ == "__main__":
    main()
