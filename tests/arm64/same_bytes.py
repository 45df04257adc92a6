#!/usr/bin/env python3
"""Tests that a build for another processor makes the same bytes: 6 generated scenes, 20 bakes of them, their rays.

Usage: same_bytes.py BUILD OTHER_BUILD [EMULATOR]    (folders of finished builds)

It shows the arithmetic only. An emulator executes the memory operations in the order of its host, so the order that
threads rely on is left to ThreadSanitizer.
"""
import hashlib
import pathlib
import subprocess
import sys
import tempfile

BUILD, OTHER = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
EMULATOR = sys.argv[3:]
SCENES = {"atrium.glb": "atrium -n 90K", "figure.glb": "figure", "city.ply": "city -n 12K --yaw 30", "hairball.ply": "hairball -n 20K",
          "scan.ply": "scan -n 100K --double --shuffle", "rectangle.obj": "rectangle -n 2"}
BAKES = {  # every rule, layout, kind of layer and colour, posed and spilled, at the ends of the lattice
    "atrium.glb": ["-r 512 --colours --colour-level 7", "-r 512 --rule thin --layers material", "-r 256 --rule solid --open surface --no-cutouts --layout compact"],
    "figure.glb": ["-r 1K --time 0.7 --colours --colour-error 0", "-r 256 --frames 0:1:0.25", "-r 512 --rule thin --time 0.3 --layout compact"],
    "city.ply": ["-r 2K", "-r 2K --rule thin", "-r 2K --rule solid --open surface", "-r 8K --bounds -1,0,-1,1,2,1 --layout compact"],
    "hairball.ply": ["-r 1K", "-r 1K --rule thin", "-r 512 --rule solid --open surface --inside odd", "-r 512 --transform 1,2,0,7,-2,1,0.3,0,0.1,0,1,0,0,0,0,1"],
    "scan.ply": ["-r 2K", "-r 1K --rule thin --layout compact", "-r 2K -m 48M", "-r 512 --scale 1e-9"],
    "rectangle.obj": ["-r 64K", "-r 4K --rule thin --layers object"]}


def run(build, folder, program, words):
    emulator = EMULATOR if build == OTHER else []
    done = subprocess.run([*emulator, build / program, *words.split()], cwd=folder, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{program} {words}: exit {done.returncode}\n{done.stderr}")


def digests(build):
    """Pairs of a command line and the hash of the file that it writes."""
    found = []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def make(program, words, output):
            run(build, folder, program, words.replace("OUT", output))
            found.append((f"{program} {words}", hashlib.sha256((folder / output).read_bytes()).hexdigest()[:16]))

        for scene, words in SCENES.items():
            make("svdag-scene", f"{words} -q -o OUT", scene)
        for scene, bakes in BAKES.items():
            for number, words in enumerate(bakes):
                make("svdag", f"build {scene} {words} -q -j 2 -o OUT", f"{scene}{number}.svdag")
            make("svdag-trace", f"{scene}0.svdag --size 96x54 --rounds 1 --samples 2 --dump OUT", "hits")
    return found


def main():
    expected, made = digests(BUILD), digests(OTHER)
    bad = 0
    for (line, one), (_, other) in zip(expected, made):
        bad += one != other
        print(f"{one} {other if other != one else 'same':16} {line}")
    print(f"{len(made) - bad} passed, {bad} failed, 0 skipped")
    return bad > 0


if __name__ == "__main__":
    sys.exit(main())
