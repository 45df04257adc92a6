"""Polls the memory and the bytes read of another process."""
import contextlib
import pathlib
import threading


def fields_of(path):
    return dict(line.split(":", 1) for line in path.read_text().splitlines())


class Peak(threading.Thread):
    """Records the peaks of anonymous plus shared memory (`own`) and of mapped files (`of_files`) of a process."""

    def __init__(self, pid, interval=0.002):
        super().__init__(daemon=True)
        self.folder, self.interval, self.done = pathlib.Path(f"/proc/{pid}"), interval, threading.Event()
        self.own = self.of_files = self.read = 0

    def run(self):
        while not self.done.wait(self.interval):
            with contextlib.suppress(OSError):
                fields = fields_of(self.folder / "status")
                anonymous, shared, files = (1024 * int(fields.get(name, "0 kB").split()[0])
                                            for name in ("RssAnon", "RssShmem", "RssFile"))
                self.own = max(self.own, anonymous + shared)
                self.of_files = max(self.of_files, files)
                self.read = int(fields_of(self.folder / "io")["rchar"])
