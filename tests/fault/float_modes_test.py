#!/usr/bin/env python3
"""A library that changes how the processor rounds, and drops denormals, changes no byte of a bake and no verdict."""
import os
import pathlib
import random
import subprocess
import tempfile

import bakes

MODIFIED = dict(os.environ, LD_PRELOAD=str(bakes.BUILD / "tests/libsvdag_float_modes.so"))
SCENES = {"denormals": 2e-306, "ordinary": 7.3}  # their size; a voxel of the first is a normal number, just so


def write_scene(path, size):
    chance = random.Random(3)
    lines = [f"v {' '.join(repr(chance.random() * size) for _ in range(3))}\n" for _ in range(120)]
    path.write_text("".join(lines) + "".join(f"f {i} {i + 1} {i + 2}\n" for i in range(1, 120, 3)))


def answer(folder, environment, output, scene):
    """What is baked of the scene, and what the judge says of it."""
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
            data, texts = answer(folder, os.environ, "plain.svdag", f"{scene}.obj")
            report.judge(f"{scene}: as it is", [text for text in texts if "exit 0" not in text])
            modified, said = answer(folder, MODIFIED, "modified.svdag", f"{scene}.obj")
            report.judge(f"{scene}: other modes", ["other bytes"] * (modified != data) +
                         [f"{b!r} instead of {a!r}" for a, b in zip(texts, said) if a != b])
    report.finish()


if __name__ == "__main__":
    main()
