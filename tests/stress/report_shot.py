#!/usr/bin/env python3
"""Tests the page of `svdag-verify report` in a real browser, headless Chromium.

Checks at desktop and phone width, light and dark: no console message, no network request, nothing wider than the
window, every picture decoded, and the colours of the requested scheme. Pages with each of these faults must fail.
The screenshots are kept in SHOTS for inspection.

Usage: report_shot.py PROGRAMS SHOTS
"""
import html
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

PROGRAMS, SHOTS = (pathlib.Path(p).resolve() for p in (sys.argv.pop(1), sys.argv.pop(1)))
CHROMIUM = shutil.which("chromium")
WIDTHS = {"desk": 1280, "phone": 390}
SCHEMES = {"dark": 0, "light": 1}  # Blink's numbers
LUMINANCE = {"dark": range(0, 96), "light": range(160, 256)}

# Shows the unchanged page in a frame of the given width (a Chromium window is at least 500 pixels wide), and stores
# the observations of the frame's parent in the document.
FRAME = """<!doctype html><body style="margin:0"><iframe style="border:0;width:%dpx;height:4200px" srcdoc="%s"></iframe>
<script>addEventListener('load', () => {
  const view = document.querySelector('iframe').contentWindow, page = view.document;
  document.body.setAttribute('data-seen', JSON.stringify({
    inner: view.innerWidth, scroll: page.documentElement.scrollWidth,
    pictures: [...page.images].map(i => i.complete ? i.naturalWidth : 0),
    plots: [...page.querySelectorAll('svg')].map(s => s.getBoundingClientRect().right),
    requests: view.performance.getEntriesByType('resource').map(r => r.name),
    background: view.getComputedStyle(page.body).backgroundColor})); });</script>"""


def chromium(page, width, scheme, *options):
    """Returns (stdout, the console messages)."""
    with tempfile.TemporaryDirectory(prefix="svdag-chromium-") as profile:
        done = subprocess.run(
            [CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking", "--no-first-run",
             "--hide-scrollbars", "--enable-logging=stderr", "--host-resolver-rules=MAP * ~NOTFOUND",
             f"--user-data-dir={profile}", f"--blink-settings=preferredColorScheme={SCHEMES[scheme]}",
             f"--window-size={width},4200", *options, page.as_uri()],
            capture_output=True, text=True, timeout=120, check=True, env=dict(os.environ, HOME=profile))
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def faults(page, width, scheme, shot=None):
    """The set of faults of a page, one word each."""
    framed = page.with_name("framed-" + page.name)
    framed.write_text(FRAME % (width, html.escape(page.read_text())))
    dom, console = chromium(framed, width, scheme, "--dump-dom")
    seen = json.loads(html.unescape(re.search(r'data-seen="([^"]*)"', dom).group(1)))
    if shot:
        chromium(framed, width, scheme, f"--screenshot={shot}")
    wrong = {"console": console, "request": seen["requests"],
             "width": seen["inner"] != width or max([seen["scroll"], *seen["plots"]]) > width,
             "pictures": len(seen["pictures"]) != 4 or 0 in seen["pictures"],
             "colours": int(re.search(r"\d+", seen["background"]).group()) not in LUMINANCE[scheme]}
    return {name for name, is_wrong in wrong.items() if is_wrong}


class ReportShot(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory(prefix="svdag-report-")
        cls.root = pathlib.Path(cls.folder.name)
        SHOTS.mkdir(parents=True, exist_ok=True)
        for command in (["svdag-scene", "atrium", "-n", "90K", "-q", "-o", "atrium.ply"],
                        ["svdag", "build", "atrium.ply", "-r", "1K", "-q", "-o", "atrium.svdag", "--report", "atrium.json"],
                        ["svdag-verify", "report", "atrium.svdag", "atrium.json", "-q", "-o", "report.html", "--size", "640x360"]):
            subprocess.run([PROGRAMS / command[0], *command[1:]], cwd=cls.root, check=True)
        cls.page = cls.root / "report.html"

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_has_no_fault_at_both_widths_in_both_schemes(self):
        for name, width in WIDTHS.items():
            for scheme in SCHEMES:
                shot = SHOTS / f"report-{name}-{scheme}.png"
                self.assertEqual(faults(self.page, width, scheme, shot), set(), f"{name}, {scheme}")
                self.assertGreater(shot.stat().st_size, 20_000)

    def faulty(self, name, change):
        page = self.root / f"{name}.html"
        text = self.page.read_text()
        changed = change(text)
        self.assertNotEqual(text, changed)
        page.write_text(changed)
        return faults(page, 390, "light")

    def test_finds_a_table_that_is_too_wide(self):
        self.assertIn("width", self.faulty("wide", lambda t: t.replace("<h1>", '<div style="width:600px">x</div><h1>')))

    def test_finds_a_damaged_picture(self):
        self.assertIn("pictures", self.faulty("damaged", lambda t: t.replace("base64,iVBOR", "base64,AAAAA", 1)))

    def test_finds_a_picture_from_another_site(self):
        self.assertIn("console", self.faulty("elsewhere", lambda t: t.replace("<h1>", '<img src="http://example.invalid/x.png"><h1>')))

    def test_finds_a_request(self):
        def change(text):
            text = re.sub(r'<meta http-equiv="Content-Security-Policy"[^>]*>', "", text)
            return text.replace("<h1>", '<img src="http://example.invalid/x.png"><h1>')
        self.assertIn("request", self.faulty("request", change))

    def test_finds_a_page_without_dark_colours(self):
        page = self.root / "bright.html"
        page.write_text(self.page.read_text().replace("prefers-color-scheme: dark", "prefers-color-scheme: none"))
        self.assertIn("colours", faults(page, 1280, "dark"))


if __name__ == "__main__":
    if CHROMIUM is None:
        print("report_shot: skipped, chromium is not on PATH")
        sys.exit(77)
    unittest.main()
