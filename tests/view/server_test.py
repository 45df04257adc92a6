#!/usr/bin/env python3
"""Tests the viewer's server against clients without its token, the page that opens a browser, and view --to.

Usage: server_test.py PROGRAMS [TEST...]. Needs no browser.
"""
import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest

PROGRAMS = None
ROOT = tempfile.TemporaryDirectory(prefix="svdag-server-")
FOLDER = pathlib.Path(ROOT.name)


def scene():
    """A file of a cube's surface."""
    output = FOLDER / "cube.svdag"
    if not output.exists():
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        faces = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]
        (FOLDER / "cube.obj").write_text("".join("v %d %d %d\n" % c for c in corners) + "".join("f %d %d %d %d\n" % f for f in faces))
        subprocess.run([PROGRAMS / "svdag", "build", FOLDER / "cube.obj", "-o", output, "-r", "1K", "-q"], check=True)
    return output


class Server:
    def __init__(self, *options, **environment):
        self.process = subprocess.Popen([PROGRAMS / "svdag-verify", "view", scene(), "--keep", *options], stdout=subprocess.PIPE,
                                        text=True, env={**os.environ, **environment})
        self.url = self.process.stdout.readline().strip()
        self.port = int(re.search(r":(\d+)/", self.url).group(1))
        self.path = "/" + self.url.split("/", 3)[3]

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.process.terminate()
        self.process.wait()
        self.process.stdout.close()

    def connect(self, timeout=20):
        return socket.create_connection(("127.0.0.1", self.port), timeout=timeout)

    def send(self, text, timeout=20):
        """The whole answer; empty if the connection was closed without one."""
        with self.connect(timeout) as client:
            try:
                client.sendall(text)
                return b"".join(iter(lambda: client.recv(65536), b""))
            except (ConnectionResetError, BrokenPipeError):
                return b""

    def get(self, path, host="127.0.0.1", more=""):
        return self.send(f"GET {path} HTTP/1.1\r\nHost: {host}\r\nConnection: close\r\n{more}\r\n".encode())

    def memory(self):
        """Resident bytes, at most so far."""
        status = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmHWM:\s+(\d+)", status).group(1)) << 10


def status(answer):
    return int(answer.split(b" ", 2)[1]) if answer else None


class WithoutTheToken(unittest.TestCase):
    """Clients without the token take neither memory nor time from the user."""

    @classmethod
    def setUpClass(cls):
        cls.server = Server("--no-open")

    @classmethod
    def tearDownClass(cls):
        cls.server.__exit__()

    def test_heads_are_bounded(self):
        before = self.server.memory()
        line = b"X-Name: " + b"x" * 1000 + b"\r\n"
        for head in [line * 64000, b"X-Long: " + b"x" * 64_000_000]:
            answer = self.server.send(b"GET / HTTP/1.1\r\nHost: localhost\r\n" + head)
            self.assertIn(status(answer), (None, 431))
        self.assertLess(self.server.memory() - before, 4 << 20)
        self.assertEqual(status(self.server.get(self.server.path)), 200)

    def test_a_head_of_16_kib_with_the_token_is_answered(self):
        more = "".join(f"X-{i}: {'y' * 1000}\r\n" for i in range(15))
        self.assertEqual(status(self.server.get(self.server.path, more=more)), 200)
        self.assertIn(status(self.server.get(self.server.path, more=more + more)), (None, 431))

    def test_slow_clients_do_not_block_others_and_have_a_deadline(self):
        clients = [self.server.connect() for _ in range(200)]
        begin = time.monotonic()
        closed = 0
        try:
            for client in clients:
                client.sendall(b"GET / HTTP/1.1\r\n")
            while time.monotonic() - begin < 9:
                begun = time.monotonic()
                self.assertEqual(status(self.server.get(self.server.path + "tiles/1")), 200)
                self.assertLess(time.monotonic() - begun, 1)
                time.sleep(0.5)
                for client in clients:
                    try:
                        client.sendall(b"X: y\r\n")
                    except OSError:
                        closed += 1
            self.assertGreaterEqual(closed, len(clients))
        finally:
            for client in clients:
                client.close()

    def test_many_idle_connections_do_not_block_others(self):
        clients = []
        try:
            for _ in range(900):
                clients.append(self.server.connect())
            begin = time.monotonic()
            self.assertEqual(status(self.server.get(self.server.path)), 200)
            self.assertLess(time.monotonic() - begin, 4)
        finally:
            for client in clients:
                client.close()

    def test_hosts_are_compared_whole(self):
        for host in ["127.0.0.1", "127.0.0.1:80", "localhost:8123", "[::1]:8123", "[::1]"]:
            self.assertEqual(status(self.server.get(self.server.path, host)), 200, host)
        for host in ["127.0.0.1:80.evil.com", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:80:80", "127.0.0.1:65536", "127.0.0.1.evil.com",
                     "evil.com", "localhost.", "", "localhost:8123\r\nHost: evil.com"]:
            self.assertEqual(status(self.server.get(self.server.path, host)), 403, host)

    def test_pages_of_others_cannot_frame_it(self):
        head = self.server.get(self.server.path).split(b"\r\n\r\n")[0]
        self.assertIn(b"Content-Security-Policy: frame-ancestors 'none'", head)

    def test_no_token_is_403(self):
        for path in ["/", "/scene.json", self.server.path[:-2] + "x/", self.server.path.upper() + "x", self.server.path[:-1]]:
            self.assertEqual(status(self.server.get(path)), 403, path)


class WithTheToken(unittest.TestCase):
    def test_1000_tiles_at_once_are_answered(self):
        with Server("--no-open") as server:
            answers, begin = [], time.monotonic()
            threads = [threading.Thread(target=lambda: answers.append(status(server.get(server.path + "tiles/1"))))
                       for _ in range(1000)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(answers, [200] * 1000)
            self.assertLess(time.monotonic() - begin, 20)

    def test_connections_are_used_again(self):
        with Server("--no-open") as server, server.connect() as client:
            for _ in range(3):
                client.sendall(f"GET {server.path}nothing HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
                self.assertEqual(status(client.recv(65536)), 404)

    def test_other_users_do_not_see_it(self):
        """What every user of the machine sees are the arguments of xdg-open and the folder of its page."""
        programs, seen = FOLDER / "bin", FOLDER / "seen"
        programs.mkdir()
        (programs / "xdg-open").write_text(f'#!/bin/sh\nstat -c "%a %n" "$1" "$(dirname "$1")" >{seen}.part\ncat "$1" >>{seen}.part\n'
                                           f'mv {seen}.part {seen}\n')
        (programs / "xdg-open").chmod(0o755)
        with Server(DISPLAY=":0", TMPDIR=str(FOLDER), PATH=f"{programs}:{os.environ['PATH']}") as server:
            for _ in range(100):
                if seen.exists():
                    break
                time.sleep(0.1)
            file, folder, text = seen.read_text().split("\n", 2)
            token = server.path.strip("/")
            self.assertNotIn(token, file + folder)
            self.assertEqual((file.split()[0], folder.split()[0]), ("600", "700"))
            self.assertIn(f'content="0; url={server.url}"', text)
            page = pathlib.Path(file.split(" ", 1)[1])
            self.assertTrue(page.exists())
        self.assertFalse(page.parent.exists())


class Folders(unittest.TestCase):
    """view --to replaces nothing that it has not written."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(dir=FOLDER)) / "site"
        self.assertEqual(self.write(), (0, ""))

    def write(self):
        done = subprocess.run([PROGRAMS / "svdag-verify", "view", scene(), "--to", self.folder, "-q"], capture_output=True, text=True)
        return done.returncode, done.stderr

    def assert_refused(self, path):
        code, message = self.write()
        self.assertEqual(code, 2, message)
        self.assertIn(str(path), message)

    def test_a_changed_page_is_refused_and_kept(self):
        for name in ["index.html", "view.js", "view.css"]:
            page = self.folder / name
            text = page.read_text()
            page.write_text(text + "<!-- mine -->")
            self.assert_refused(page)
            self.assertEqual(page.read_text(), text + "<!-- mine -->")
            page.write_text(text)
        self.assertEqual(self.write(), (0, ""))

    def test_foreign_files_are_refused(self):
        for name in ["notes.txt", "tiles/notes.txt", "tiles/0", "tiles/01", "tiles/99999999", ".hidden"]:
            foreign = self.folder / name
            foreign.write_text("mine")
            self.assert_refused(foreign)
            self.assertEqual(foreign.read_text(), "mine")
            foreign.unlink()
        (self.folder / "more").mkdir()
        self.assert_refused(self.folder / "more")

    def test_links_are_refused(self):
        page, elsewhere = self.folder / "index.html", self.folder.parent / "elsewhere"
        page.rename(elsewhere)
        page.symlink_to(elsewhere)
        self.assert_refused(page)

    def test_a_stopped_run_is_continued(self):
        for name in ["index.html", "view.js", "tiles/1"]:
            (self.folder / name).unlink()
        self.assertEqual(self.write(), (0, ""))
        for name in ["index.html", "view.js", "tiles/1"]:
            self.assertTrue((self.folder / name).exists())


if __name__ == "__main__":
    PROGRAMS = pathlib.Path(sys.argv.pop(1)).resolve()
    unittest.main(verbosity=2)
