#!/usr/bin/env python3
"""Makes the picture of the viewer in docs/images.

Usage: picture.py PROGRAMS FILE PICTURE.png
"""
import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from browser import Browser  # noqa: E402

programs, file, picture = map(pathlib.Path, sys.argv[1:])
VIEW = "#eye=-10.5,2.2,1.8&to=6,3.4,-1.2&fov=75&colours=layer"
with subprocess.Popen([programs / "svdag-verify", "view", file, "--no-open", "--keep"], stdout=subprocess.PIPE, text=True) as server:
    try:
        url = server.stdout.readline().strip()
        with Browser(1000, 620) as page:
            page.open(url + VIEW)
            page.wait("window.viewer")
            page.run("viewer.whenSettled()")
            page.run("viewer.pick(400, 500)")
            page.run("viewer.whenSettled()")
            page.wait("viewer.sample === viewer.samples")
            page.picture(picture)
    finally:
        server.kill()
