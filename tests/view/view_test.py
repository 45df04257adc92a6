#!/usr/bin/env python3
"""Tests the viewer in a headless Chromium: it shows the voxels that rays through the file hit, loads no more than it
needs, keeps within its memory, and survives its server.

Usage: view_test.py PROGRAMS [TEST...]. With SVDAG_SCENES the scenes are real ones, else those of svdag-scene. Prints the
figures of docs/viewing.md.
"""
import base64
import functools
import http.client
import http.server
import json
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from browser import Browser  # noqa: E402

WIDTH, HEIGHT = 640, 360
PROGRAMS = None
SCENES = os.environ.get("SVDAG_SCENES")
ROOT = tempfile.TemporaryDirectory(prefix="svdag-view-")
FOLDER = pathlib.Path(ROOT.name)


def program(*arguments, code=0):
    done = subprocess.run([PROGRAMS / arguments[0], *map(str, arguments[1:])], capture_output=True, text=True)
    if done.returncode != code:
        raise AssertionError(f"{arguments}: {done.returncode}, {done.stdout}{done.stderr}")
    return done.stdout + done.stderr


@functools.cache
def baked(shared, kind, *options):
    """A file of a shared scene, or without them of a generated one."""
    output = FOLDER / f"{len(list(FOLDER.glob('*.svdag')))}-{kind}.svdag"
    scene = pathlib.Path(SCENES or "", shared)
    if SCENES is None:
        scene = FOLDER / f"{kind}.obj"
        if not scene.exists():
            program("svdag-scene", kind, "-n", "90K", "-o", scene)
    program("svdag", "build", scene, "-o", output, "-q", *options)
    return output


def sponza16k():
    return baked("crytek_sponza.glb", "atrium", "-r", "16K")


def coloured():
    return baked("stk_black_forest_textured.glb", "city", "-r", "2K", "--colours", "--layers", "material")


def info(file):
    return json.loads(program("svdag", "info", file, "--json"))


def layers(file):
    return json.loads(program("svdag", "info", file, "--layers", "--json"))["layer_table"]


def cameras(file, count=2, seed=1):
    """Cameras around and inside what is set: position, target, angle."""
    random = numpy.random.default_rng(seed)
    low, high = numpy.array(info(file)["occupied"]["bounds"]).reshape(2, 3)
    middle, size = (low + high) / 2, numpy.linalg.norm(high - low)
    found = []
    for i in range(count):
        away = random.normal(size=3)
        away /= numpy.linalg.norm(away)
        inside = low + (high - low) * random.uniform(0.3, 0.7, 3)
        eye, target = (middle + size * away, middle) if i % 2 == 0 else (inside, inside + away)
        found.append([*map(float, eye), *map(float, target), 40.0 if i % 2 == 0 else 70.0])
    return found


def traced(file, camera):
    """What svdag-trace hits: arrays of found, x, y, z, level and axis, row by row."""
    dump = FOLDER / "hits.bin"
    program("svdag-trace", file, "--size", f"{WIDTH}x{HEIGHT}", "--camera=" + ",".join(map(repr, camera)), "--dump", dump,
            "--samples", "1")
    return numpy.fromfile(dump, numpy.uint32).reshape(HEIGHT, WIDTH, 14)[:, :, :6]


def light(code):
    """Linear light of sRGB codes, 0 to 255."""
    v = numpy.asarray(code) / 255
    return numpy.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)


def code(light):
    v = numpy.clip(light, 0, 1)
    return 255 * numpy.where(v <= 0.0031308, 12.92 * v, 1.055 * v ** (1 / 2.4) - 0.055)


def differing(shown, hits):
    """The share of pixels that do not show the cube that a ray hits."""
    same = (hits[:, :, 0] == shown[:, :, 0]) & ((shown[:, :, 0] == 0) | (hits == shown).all(axis=2))
    return 1 - same.mean()


class Server:
    def __init__(self, file, *options):
        self.process = subprocess.Popen([PROGRAMS / "svdag-verify", "view", file, "--no-open", *options],
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.url = self.process.stdout.readline().strip()
        if not self.url:
            raise AssertionError(self.process.stderr.read())

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.kill()
        self.process.wait()
        self.process.stdout.close()
        self.process.stderr.close()

    def get(self, path, host=None, method="GET", headers=None):
        """Status, headers and body."""
        name = self.url.split("/")[2]
        connection = http.client.HTTPConnection(name, timeout=20)
        connection.request(method, path, headers={"Host": host or name, **(headers or {})})
        answer = connection.getresponse()
        body = answer.read()
        connection.close()
        return answer.status, answer.headers, body

    @property
    def path(self):
        return "/" + self.url.split("/", 3)[3]


class Page(Browser):
    """The viewer of a URL, with pictures of a fixed size and one ray per pixel."""

    def __init__(self, url, camera=None, **options):
        super().__init__(WIDTH, HEIGHT, options.pop("flags", ()))
        try:
            parts = dict(options)
            if camera:
                parts.update(eye=",".join(map(repr, camera[:3])), to=",".join(map(repr, camera[3:6])), fov=camera[6])
            self.open(url + "#" + "&".join(f"{k}={v}" for k, v in parts.items()))
            self.wait("window.viewer")
            self.run(f"viewer.fixedSize = [{WIDTH}, {HEIGHT}], viewer.samples = 1, viewer.budget")
        except BaseException:
            self.close()
            raise

    def look(self, camera):
        """Moves to a camera in world units."""
        self.run(f"""(() => {{
            const s = viewer.scene, at = (p) => p.map((v, a) => (v - s.corner[a]) / s.voxel_size);
            viewer.camera.look(at({camera[:3]}), at({camera[3:6]}), {camera[6]});
            viewer.touch();
        }})()""")

    def settle(self):
        self.run("viewer.whenSettled()")

    def bytes_of(self, array):
        """The bytes of a typed array, which an expression of async code gives."""
        return base64.b64decode(self.run(f"""(async () => {{
            const bytes = new Uint8Array(({array}).buffer), parts = [];
            for (let i = 0; i < bytes.length; i += 32768) parts.push(String.fromCharCode(...bytes.subarray(i, i + 32768)));
            return btoa(parts.join(''));
        }})()"""))

    def words(self):
        return numpy.frombuffer(self.bytes_of("viewer.tracer.read()"), numpy.uint32).reshape(HEIGHT, WIDTH, 4)[::-1]

    def colours(self):
        """What the picture shows: whether a pixel has a colour, and which."""
        words = self.words()[:, :, 3]
        return (words >> 7 & 1) == 1, numpy.stack([words >> bit & 255 for bit in (8, 16, 24)], axis=2)

    def rendered(self, file, camera, mode):
        """The picture of svdag-verify render, as sRGB codes."""
        picture = FOLDER / "picture.png"
        program("svdag-verify", "render", file, "-o", picture, "--size", f"{WIDTH}x{HEIGHT}", "--supersample", "1", "--mode", mode,
                "--camera=" + ",".join(map(repr, camera)))
        text = base64.b64encode(picture.read_bytes()).decode()
        pixels = self.bytes_of(f"""await (async () => {{
            const bytes = Uint8Array.from(atob('{text}'), (c) => c.charCodeAt(0));
            const image = await createImageBitmap(new Blob([bytes]), {{colorSpaceConversion: 'none'}});
            const canvas = new OffscreenCanvas(image.width, image.height), to = canvas.getContext('2d');
            to.drawImage(image, 0, 0);
            return to.getImageData(0, 0, image.width, image.height).data;
        }})()""")
        return numpy.frombuffer(pixels, numpy.uint8).reshape(HEIGHT, WIDTH, 4)[:, :, :3].astype(float)

    def hits(self):
        """What the picture shows, as traced()."""
        words = self.words()
        found = words[:, :, 3] != 0
        hits = numpy.zeros((HEIGHT, WIDTH, 6), numpy.uint32)
        hits[:, :, 0] = found
        hits[:, :, 1:4] = (words[:, :, :3] & 0xfffff) * found[:, :, None]
        hits[:, :, 4], hits[:, :, 5] = words[:, :, 3] & 31, words[:, :, 3] >> 5 & 3
        return hits

    def sent_bytes(self):
        """Bytes that came over the network."""
        return int(self.run("performance.getEntriesByType('resource').concat(performance.getEntriesByType('navigation'))"
                            ".reduce((sum, entry) => sum + entry.transferSize, 0)"))


class Pictures(unittest.TestCase):
    """What is shown is what is there."""

    def test_hits_are_those_of_the_tracer(self):
        inside = [[-9, 2, 0, 8, 3, 0.5, 65.0], [-2, 1.5, 0.4, 3, 1, -4, 70.0]]
        files = [(sponza16k(), inside if SCENES else None),
                 (baked("stanford_dragon.ply", "scan", "-r", "2K", "--layout", "compact"), None),
                 (baked("samurai_monastery.obj", "city", "-r", "4K", "--layers", "material"), None),
                 (baked("stk_black_forest.glb", "terrain", "-r", "2K"), None),
                 (baked("trimesh_fandisk.obj", "hairball", "-r", "512", *(["--rule", "solid"] if SCENES else [])), None)]
        shares, hit = [], 0
        for file, given in files:
            with Server(file) as server, Page(server.url, detail=0, memory=1024) as page:
                for camera in given or cameras(file):
                    page.look(camera)
                    page.settle()
                    hits = traced(file, camera)
                    shares.append(differing(page.hits(), hits))
                    hit += hits[:, :, 0].mean() / 10
                self.assertEqual(page.errors(), [])
        print(f"pixels that differ from svdag-trace: {100 * max(shares):.4f} % at most, {100 * sum(shares) / len(shares):.4f} % "
              f"on average; {100 * hit:.0f} % hit", file=sys.stderr)
        self.assertEqual(len(shares), 10)
        self.assertGreater(hit, 0.2)
        self.assertLess(max(shares), 0.001)

    def test_hits_at_64k(self):
        file = baked("crytek_sponza.glb", "atrium", "-r", "64K")
        camera = [-11.0, 2.0, 1.0, -11.5, 1.7, 1.2, 60.0] if SCENES else cameras(file)[1]
        with Server(file) as server, Page(server.url, camera, detail=0) as page:
            page.settle()
            share = differing(page.hits(), traced(file, camera))
            print(f"at 64K^3, a wall at half a metre: {100 * share:.4f} %", file=sys.stderr)
            self.assertLess(share, 0.001)

    def test_a_layer_alone_is_that_of_its_own_bake(self):
        if SCENES is None:
            self.skipTest("needs a scene with materials")
        cube = ["--cube=-5000,-5000,-5000,10000"]
        both = baked("samurai_monastery.obj", "city", "-r", "2K", "--layers", "material", *cube)
        table = layers(both)
        names = [layer["name"] for layer in table]
        name = max(table, key=lambda layer: layer["voxels"])["name"]
        alone = baked("samurai_monastery.obj", "city", "-r", "2K", "--include", "material:" + name, *cube)
        camera = cameras(both)[0]
        hidden = ",".join(str(i) for i in range(len(names)) if names[i] != name)
        with Server(both) as server, Page(server.url, camera, detail=0, hide=hidden) as page:
            page.settle()
            hits = traced(alone, camera)
            self.assertGreater(hits[:, :, 0].mean(), 0.001)
            self.assertLess(differing(page.hits(), hits), 0.001)

    def test_the_slider_shows_one_frame(self):
        scene = pathlib.Path(__file__).resolve().parent.parent / "cli" / "moving_scene.py"
        subprocess.run([sys.executable, "-B", scene, "100"], cwd=FOLDER, check=True)
        frames, alone = FOLDER / "frames.svdag", FOLDER / "frame.svdag"
        program("svdag", "build", FOLDER / "moving.gltf", "-o", frames, "-q", "-r", "1K", "--frames", "0:2:0.5")
        camera = cameras(frames)[0]
        with Server(frames) as server, Page(server.url, camera, detail=0) as page:
            for i, name in enumerate(["0.0", "0.5", "1.0"]):
                program("svdag", "convert", frames, "-o", alone, "-q", "--layer", name)
                page.run(f"(() => {{ const one = document.querySelector('.layers + .row input'); one.value = {i}; one.oninput(); }})()")
                page.settle()
                hits = traced(alone, camera)
                self.assertGreater(hits[:, :, 0].mean(), 0.001)
                self.assertLess(differing(page.hits(), hits), 0.001)

    def test_colours_are_those_of_the_renderer(self):
        """A picture in one colour gives the light; in it, the page's colours are the coloured picture."""
        clay, error = numpy.array([0.50, 0.46, 0.40]), 9
        files = [(baked("damaged_helmet.glb", "scan", "-r", "1K", "--colours", "--colour-level", "10"), 0), (coloured(), 1)]
        for file, number in files:
            with Server(file) as server, Page(server.url, detail=0) as page:
                camera = cameras(file)[number]
                page.look(camera)
                page.settle()
                first = page.run("performance.getEntriesByType('resource').map((e) => e.name).find((n) => n.includes('/colours/'))")
                self.assertIn("/colours/1/", first)  # coarse colours first
                hits, shown = traced(file, camera), page.hits()
                has_colour, colours = page.colours()
                same = (hits == shown).all(axis=2) & (shown[:, :, 0] == 1)
                self.assertGreater(same.sum(), 1000)
                albedo = numpy.where(has_colour[:, :, None], light(colours), clay)
                expected = code(light(page.rendered(file, camera, "primary")) * albedo / clay)
                off = numpy.linalg.norm(expected - page.rendered(file, camera, "colour"), axis=2)[same]
                print(f"colours of {file.name}: {100 * (off > error).mean():.4f} % of {same.sum():,} pixels differ by more than "
                      f"{error}; {off.mean():.2f} on average; {page.run('viewer.status.textContent')}", file=sys.stderr)
                self.assertLess((off > error).mean(), 0.001)
                self.assertGreater(colours[same].std(), 5)
                self.assertEqual(page.errors(), [])
                y, x = [int(v[len(v) // 2]) for v in numpy.nonzero(same & has_colour)]
                picked = page.run(f"viewer.pick({x + 0.5}, {y + 0.5})")
                self.assertEqual(picked["colour"], [int(v) for v in colours[y, x]])
                self.assertIn("colour #%02x%02x%02x" % tuple(picked["colour"]), page.run("viewer.picture.textContent"))

    def test_sections_show_only_their_box(self):
        file = baked("stanford_dragon.ply", "scan", "-r", "2K", "--layout", "compact")
        low, high = numpy.array(info(file)["occupied"]["voxels"]).reshape(2, 3)
        box = [(2 * l + h) // 3 for l, h in zip(low, high)] + [(l + 2 * h) // 3 for l, h in zip(low, high)]
        with Server(file) as server, Page(server.url, cameras(file)[0], detail=0, clip=",".join(map(str, box))) as page:
            page.settle()
            hits = page.hits()
            voxels = hits[hits[:, :, 0] > 0][:, 1:4]
            self.assertGreater(len(voxels), 1000)
            self.assertTrue((voxels >= box[:3]).all() and (voxels < box[3:]).all())

    def test_a_picked_voxel_has_its_place_and_layers(self):
        file = baked("samurai_monastery.obj", "city", "-r", "4K", "--layers", "material")
        camera = cameras(file)[0]
        with Server(file) as server, Page(server.url, camera, detail=0) as page:
            page.settle()
            hits = traced(file, camera)
            y, x = [int(v[len(v) // 2]) for v in numpy.nonzero(hits[:, :, 0])]
            picked = page.run(f"viewer.pick({x + 0.5}, {y + 0.5})")
            self.assertEqual(picked["voxel"], [int(v) for v in hits[y, x, 1:4]])
            self.assertEqual(picked["level"], 12)
            grid = info(file)["grid"]
            world = [c + (v + 0.5) * grid["voxel_size"] for c, v in zip(grid["corner"], picked["voxel"])]
            names = [layers(file)[i]["name"] for i in picked["layers"]]
            text = page.run("viewer.picture.textContent")
            self.assertTrue(names and all(name in text for name in names), (names, text))
            at = list(map(float, text.split("at ")[1].split("\n")[0].split(",")))
            numpy.testing.assert_allclose(at, world, rtol=1e-6, atol=1e-6)
            # The voxel is that of its layers when they are baked alone.
            for name in names:
                alone = FOLDER / "alone.svdag"
                program("svdag", "build", pathlib.Path(SCENES or FOLDER, "samurai_monastery.obj" if SCENES else "city.obj"),
                        "-o", alone, "-q", "-r", "4K", "--include", ("material:" if SCENES else "") + name,
                        "--cube=" + ",".join(map(repr, [*grid["corner"], 4096 * grid["voxel_size"]])))
                found = subprocess.run([PROGRAMS / "svdag", "query", alone], input=" ".join(map(repr, world)), text=True,
                                       capture_output=True).stdout
                self.assertTrue(found.startswith("set"), found)


class Loading(unittest.TestCase):
    """Only what a view needs is loaded, coarse first, within the memory."""

    def test_the_first_picture_needs_little(self):
        with Server(sponza16k(), "--keep") as server:
            seconds, sent = [], []
            for _ in range(3):
                with Page(server.url) as page:
                    page.wait("viewer.first")
                    seconds.append(page.run("viewer.first.seconds"))
                    sent.append(page.run("viewer.first.bytes"))
            with Page(server.url) as page:
                page.settle()
                all_sent = page.sent_bytes()
        print(f"first picture of 16K^3: {min(seconds):.2f} s, {sent[0]:,} bytes; complete: {all_sent:,} bytes", file=sys.stderr)
        self.assertLess(min(seconds), 3)
        self.assertLess(sent[0], 2e6)

    def test_an_orbit_loads_what_it_shows(self):
        file = sponza16k()
        size = file.stat().st_size
        with Server(file) as server, Page(server.url) as page:
            page.run("viewer.camera.zoom(0.3)")
            page.settle()
            begin = page.sent_bytes()
            page.run("""(async () => {
                for (let i = 0; i < 12; ++i) { viewer.camera.turn(2 * Math.PI / 12, 0); await viewer.whenSettled(); }
            })()""", 600)
            page.run("0")
            sent, tiles = page.sent_bytes() - begin, page.run("viewer.tiles.count")
            seen = page.run("[...viewer.tiles.byId.values()].filter((t) => t.rows > 0 && t.seen === 0).length")
            milliseconds = page.run("viewer.status.textContent")
        print(f"orbit of 12 pictures: {sent:,} bytes for {tiles} tiles, of a file of {size:,}; {milliseconds}", file=sys.stderr)
        self.assertEqual(seen, 0)  # every tile was in a picture
        self.assertLess(sent, size / 10)

    def test_memory_stays_within_its_budget(self):
        file, budget = coloured(), 16
        path = [c for seed in range(4) for c in cameras(file, 2, seed)]
        with Server(file) as server, Page(server.url, memory=budget) as page:
            for camera in path:
                page.look(camera)
                page.settle()
                used, held = page.run("[viewer.tiles.usedBytes, viewer.tiles.pool.bytes]")
                self.assertLessEqual(used, held)
                self.assertLessEqual(held, budget << 20)
                # No holes: what a ray hits is covered by a cube of some level.
                hits, shown = traced(file, camera), page.hits()
                self.assertEqual(int((hits[:, :, 0] > shown[:, :, 0]).sum()), 0)
            self.assertGreater(page.run("[...viewer.tiles.byId.values()].filter((t) => t.tile && t.rows > 0).length"), 0)
            self.assertEqual(page.errors(), [])

    def test_a_full_memory_is_reported_and_not_a_loop(self):
        file = sponza16k()
        with Server(file) as server, Page(server.url, cameras(file)[0], detail=0, memory=8) as page:
            page.settle()
            self.assertIn("does not fit", page.run("viewer.status.textContent"))


class Serving(unittest.TestCase):
    """The server serves one file to one user, and no one else."""

    def setUp(self):
        self.file = baked("trimesh_fandisk.obj", "hairball", "-r", "512", *(["--rule", "solid"] if SCENES else []))

    def test_wrong_tokens_hosts_and_methods_are_refused(self):
        with Server(self.file) as server:
            token = server.path
            self.assertEqual(server.get(token)[0], 200)
            self.assertEqual(server.get(token + "scene.json")[0], 200)
            for path in ["/", "/x/", token[:-2] + "/", "/" + "0" * 32 + "/scene.json", token.upper() + "x", "//" + token[1:]]:
                self.assertEqual(server.get(path)[0], 403, path)
            for host in ["evil.example", "evil.example:80", "127.0.0.1.evil.example", "localhost.evil.example:1", "x127.0.0.1"]:
                self.assertEqual(server.get(token, host)[0], 403, host)
            self.assertEqual(server.get(token, "localhost:1234")[0], 200)  # through a tunnel
            for path in ["tiles/", "tiles/0", "tiles/2", "tiles/-1", "tiles/99999999999999999999", "tiles/1x", "../../etc/passwd",
                         "tiles/../scene.json", "%2e%2e/", "nothing", "colours/", "colours/1", "colours/1/9"]:
                self.assertEqual(server.get(token + path)[0], 404, path)
            for method in ["POST", "PUT", "DELETE", "OPTIONS"]:
                self.assertIn(server.get(token, method=method)[0], (405, 413), method)

    def test_what_is_there_already_is_not_sent_again(self):
        with Server(self.file) as server:
            for name in ["tiles/1", "view.js", "scene.json"]:
                status, headers, body = server.get(server.path + name)
                self.assertEqual(status, 200)
                again = server.get(server.path + name, headers={"If-None-Match": headers["ETag"]})
                self.assertEqual((again[0], again[2]), (304, b""))
        with Server(self.file, "--level", "5", "--at", server.url) as coarse:
            again = coarse.get(coarse.path + "scene.json", headers={"If-None-Match": headers["ETag"]})
            self.assertEqual(again[0], 200)  # another scene at the same address
        with Server(self.file) as server:
            part = server.get(server.path + "view.js", headers={"Range": "bytes=10-19"})
            self.assertEqual((part[0], part[2]), (206, server.get(server.path + "view.js")[2][10:20]))

    def test_it_ends_by_interrupt_and_when_the_page_is_closed(self):
        # A process in the background, as of nohup, ignores interrupts, and its children inherit that.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        with Server(self.file, "--keep") as server:
            server.process.send_signal(signal.SIGINT)
            self.assertEqual(server.process.wait(10), 130)
            self.assertIn("stopped serving", server.process.stderr.read())
        with Server(self.file) as server:
            with Page(server.url) as page:
                page.settle()
                time.sleep(12)
                self.assertIsNone(server.process.poll())  # the page is open
            self.assertEqual(server.process.wait(30), 0)

    def test_a_page_goes_on_after_its_server_was_killed(self):
        file = sponza16k()
        camera = [-9, 2, 0, 8, 3, 0.5, 65.0] if SCENES else cameras(file)[1]
        with Server(file) as server:
            url = server.url
            page = Page(url)
            page.settle()
        with page:
            page.look(camera)
            page.run("viewer.detail = 0")
            time.sleep(3)
            self.assertFalse(page.run("viewer.settled"))
            with Server(file, "--at", url) as server:
                self.assertEqual(server.url, url)
                page.settle()
                self.assertLess(differing(page.hits(), traced(file, camera)), 0.001)

    def test_a_used_port_is_one_sentence(self):
        with Server(self.file) as server:
            port = server.url.split(":")[2].split("/")[0]
            self.assertIn("in use", program("svdag-verify", "view", self.file, "--at", port, code=2))


class QuietHandler(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_):
        pass


class Folders(unittest.TestCase):
    """The page as files shows the same."""

    @classmethod
    def setUpClass(cls):
        cls.file = baked("samurai_monastery.obj", "city", "-r", "4K", "--layers", "material")
        cls.folder = FOLDER / "site"
        cls.printed = program("svdag-verify", "view", cls.file, "--to", cls.folder)
        handler = functools.partial(QuietHandler, directory=cls.folder)
        cls.web = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=cls.web.serve_forever, daemon=True).start()
        cls.url = f"http://127.0.0.1:{cls.web.server_port}/"

    @classmethod
    def tearDownClass(cls):
        cls.web.shutdown()
        cls.web.server_close()

    def test_a_folder_shows_what_the_server_shows(self):
        camera = cameras(self.file)[0]
        with Page(self.url, camera, detail=0) as page:
            page.settle()
            self.assertLess(differing(page.hits(), traced(self.file, camera)), 0.001)
            self.assertEqual(page.errors(), [])

    def test_a_folder_shows_the_colours_that_the_server_shows(self):
        """At 1K³, of tiles of two levels, some of which show coarser colours."""
        for file in [baked("damaged_helmet.glb", "scan", "-r", "1K", "--colours", "--colour-level", "10"), coloured()]:
            folder = FOLDER / f"{file.stem}-site"
            printed = program("svdag-verify", "view", file, "--to", folder).splitlines()
            estimate, size = (float(line.split()[-2]) for line in printed[:2])
            self.assertLess(abs(size / estimate - 1), 0.5)
            before = {path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}
            self.assertGreater(len(list((folder / "colours").iterdir())), 4)
            program("svdag-verify", "view", file, "--to", folder, "-q")
            self.assertEqual({path: path.read_bytes() for path in folder.rglob("*") if path.is_file()}, before)
            camera, shown = cameras(file)[0], []
            handler = functools.partial(QuietHandler, directory=folder)
            with Server(file) as server, http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as web:
                threading.Thread(target=web.serve_forever, daemon=True).start()
                for url in [server.url, f"http://127.0.0.1:{web.server_port}/"]:
                    with Page(url, camera, detail=0) as page:
                        page.settle()
                        self.assertEqual(page.errors(), [])
                        shown.append((page.hits(), *page.colours()))
                web.shutdown()
            for served, of_folder in zip(*shown):
                self.assertTrue(numpy.array_equal(served, of_folder))
            self.assertGreater(shown[1][1].mean(), 0.02)  # pixels with a colour

    def test_its_size_is_printed_before(self):
        first, second = self.printed.splitlines()[:2]
        self.assertIn("about", first)
        self.assertIn("written", second)

    def test_a_stopped_run_is_continued(self):
        folder = FOLDER / "stopped"
        shutil.copytree(self.folder, folder)
        tiles = sorted((folder / "tiles").iterdir())
        before = tiles[0].stat().st_mtime_ns
        (folder / "index.html").unlink()
        tiles[1].unlink()
        tiles[2].write_bytes(tiles[2].read_bytes()[:-9])
        program("svdag-verify", "view", self.file, "--to", folder)
        for tile in sorted(self.folder.rglob("*")):
            if tile.is_file():
                self.assertEqual((folder / tile.relative_to(self.folder)).read_bytes(), tile.read_bytes(), tile)
        self.assertEqual(tiles[0].stat().st_mtime_ns, before)

    def test_folders_are_not_mixed(self):
        other = FOLDER / "other"
        other.mkdir()
        (other / "notes.txt").write_text("mine")
        self.assertIn("not empty", program("svdag-verify", "view", self.file, "--to", other, code=2))
        self.assertIn("another", program("svdag-verify", "view", self.file, "--to", self.folder, "--level", "10", code=2))

    def test_a_damaged_tile_is_reported(self):
        folder = FOLDER / "damaged"
        shutil.copytree(self.folder, folder)
        for tile in (folder / "tiles").iterdir():
            if tile.name != "1":
                tile.write_bytes(b"no tile")
        handler = functools.partial(QuietHandler, directory=folder)
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as web:
            threading.Thread(target=web.serve_forever, daemon=True).start()
            with Page(f"http://127.0.0.1:{web.server_port}/", cameras(self.file)[0], detail=0) as page:
                page.settle()
                self.assertIn("cannot be loaded", page.run("viewer.message.textContent"))
                self.assertGreater(page.hits()[:, :, 0].mean(), 0.01)  # the root's voxels
            web.shutdown()


class Manners(unittest.TestCase):
    """The page as people meet it."""

    def setUp(self):
        self.file = baked("trimesh_fandisk.obj", "hairball", "-r", "512", *(["--rule", "solid"] if SCENES else []))

    def test_the_url_keeps_the_view(self):
        with Server(self.file, "--keep") as server, Page(server.url) as page:
            page.run("viewer.camera.turn(1, 0.3), viewer.camera.zoom(0.5), viewer.mode = 2, viewer.clip[0][1] += 3, viewer.touch()")
            page.settle()
            view = "[viewer.camera.eye, viewer.camera.target, viewer.mode, viewer.clip]"
            before, url = page.run(f"JSON.stringify({view})"), page.run("location.href")
            page.open(url)
            page.wait("window.viewer")
            after = json.loads(page.run(f"JSON.stringify({view})"))
            for a, b in zip(json.loads(before), after):
                numpy.testing.assert_allclose(a, b, atol=1e-6)

    def test_keys_and_wheel_move_the_camera(self):
        with Server(self.file, "--keep") as server, Page(server.url) as page:
            page.settle()
            eye = page.run("viewer.camera.eye")
            for key in ["ArrowRight", "w", "+"]:
                page.run("viewer.canvas.focus()")
                page.send("Input.dispatchKeyEvent", type="keyDown", key=key)
                time.sleep(0.6)
                page.send("Input.dispatchKeyEvent", type="keyUp", key=key)
                page.settle()
                moved = page.run("viewer.camera.eye")
                self.assertNotEqual(eye, moved, key)
                eye = moved
            page.send("Input.dispatchMouseEvent", type="mouseWheel", x=100, y=100, deltaX=0, deltaY=100)
            page.settle()
            self.assertNotEqual(eye, page.run("viewer.camera.eye"))
            for kind, x in [("mousePressed", 100), ("mouseMoved", 160), ("mouseReleased", 160)]:
                page.send("Input.dispatchMouseEvent", type=kind, x=x, y=200, button="left", buttons=1, clickCount=1)
            self.assertIsNone(page.run("viewer.picked ?? null"))  # dragging does not pick
            page.send("Input.dispatchKeyEvent", type="keyDown", key="Home")
            page.settle()

    def test_every_control_has_a_name(self):
        file = baked("samurai_monastery.obj", "city", "-r", "4K", "--layers", "material")
        with Server(file, "--keep") as server, Page(server.url) as page:
            nodes = page.send("Accessibility.getFullAXTree")["nodes"]
            roles = ("button", "checkbox", "slider", "combobox", "image", "img")
            controls = [n for n in nodes if n.get("role", {}).get("value") in roles and not n.get("ignored")]
            self.assertGreater(len(controls), 10)
            self.assertEqual([n for n in controls if not n.get("name", {}).get("value")], [])

    def test_it_follows_dark_colours(self):
        with Server(self.file, "--keep") as server, Page(server.url) as page:
            for scheme, is_dark in [("light", False), ("dark", True)]:
                page.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-color-scheme", "value": scheme}])
                page.settle()
                colour = page.run("getComputedStyle(viewer.parent).backgroundColor")
                background = page.run("viewer.look().background[0]")
                self.assertEqual(background < 0.5, is_dark)
                self.assertEqual(int(colour.split("(")[1].split(",")[0]) < 128, is_dark)

    def test_without_webgl2_there_is_a_message(self):
        with Server(self.file, "--keep") as server, Browser(WIDTH, HEIGHT, ["--disable-3d-apis"]) as page:
            page.open(server.url)
            page.wait("document.querySelector('.message')")
            self.assertIn("WebGL2", page.run("document.querySelector('.message').textContent"))

    def test_the_report_shows_it_without_a_network(self):
        report = FOLDER / "report.html"
        file = baked("damaged_helmet.glb", "scan", "-r", "1K", "--colours", "--colour-level", "10")
        program("svdag-verify", "report", file, "-o", report, "--size", "160x90")
        self.assertLess(report.stat().st_size, 4 << 20)
        with Browser(WIDTH, HEIGHT) as page:
            page.send("Network.emulateNetworkConditions", offline=True, latency=0, downloadThroughput=-1, uploadThroughput=-1)
            page.open(report.as_uri())
            page.wait("window.viewer")
            page.run("viewer.whenSettled()")
            self.assertGreater(page.run("viewer.tracer.read().filter((v, i) => i % 4 === 3 && v & 128).length"), 1000)
            self.assertEqual(page.errors(), [])
        with Browser(WIDTH, HEIGHT, ["--disable-3d-apis"]) as page:
            page.open(report.as_uri())
            self.assertTrue(page.run("document.getElementById('svdag').hidden"))
            self.assertEqual(page.run("[...document.images].filter((i) => i.naturalWidth === 160).length"), 4)


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    if shutil.which("chromium") is None:
        sys.exit("chromium is not installed")
    unittest.main(verbosity=2)
