"""Possible states of a disk after a power cut: replays the log of log.h up to any operation.

A file has its synced content. Any of the writes and truncations after its last sync may be present, writes also in part
(in blocks of 4 KiB); a file that grew may have zeros where data is missing. A folder has its names at its last sync; any
of the later creations, replacements and removals may be present, independently, which is weaker than journaling file
systems guarantee. After LevelDB's fault injection and ALICE (Pillai et al., OSDI 2014).
"""
import pathlib
from typing import NamedTuple

BLOCK = 4096


class Operation(NamedTuple):
    what: str
    inode: int
    offset: int
    path: str
    data: bytes


def operations(log):
    """Parses the bytes of a log."""
    found, at = [], 0
    while at < len(log):
        end = log.index(b"\n", at)
        what, inode, offset, size, path = log[at:end].decode().split(" ", 4)
        at = end + 1 + int(size)
        found.append(Operation(what, int(inode), int(offset), path.removesuffix(" (deleted)"), log[end + 1:at]))
    return found


def write_at(content, offset, data):
    content.extend(bytes(max(0, offset + len(data) - len(content))))
    content[offset:offset + len(data)] = data


def resize(content, size):
    content.extend(bytes(max(0, size - len(content))))
    del content[size:]


class File:
    def __init__(self, content=b""):
        self.durable = bytearray(content)
        self.pending = []  # (offset, data), or (size, None) of a truncation
        self.syncs = 0

    def change(self, content, kept=lambda: True):
        for offset, data in self.pending:
            if data is None:
                if kept():
                    resize(content, offset)
                continue
            begin = offset
            while begin < offset + len(data):
                end = min(offset + len(data), (begin // BLOCK + 1) * BLOCK)
                if kept():
                    write_at(content, begin, data[begin - offset:end - offset])
                begin = end
        return content

    def now(self):
        return self.change(bytearray(self.durable))

    def sync(self):
        self.change(self.durable)
        self.pending = []
        self.syncs += 1

    def after_cut(self, chance, random):
        if not self.pending or chance == 1:
            return bytes(self.now())
        content = self.change(bytearray(self.durable), lambda: random.random() < chance)
        if random.random() < 0.5:  # the size is on disk, the data is not
            resize(content, max(len(content), len(self.now())))
        return bytes(content)


class Folder:
    def __init__(self, names=()):
        self.durable = dict(names)
        self.pending = []  # {name: File, Folder or None}: the changes of one operation

    def now(self):
        names = dict(self.durable)
        for change in self.pending:
            names.update(change)
        return {name: what for name, what in names.items() if what is not None}

    def sync(self):
        self.durable, self.pending = self.now(), []

    def names_after_cut(self, chance, random):
        if chance == 1:
            return self.now()
        names = dict(self.durable)
        for change in self.pending:
            names.update({name: what for name, what in change.items() if random.random() < chance})
        return {name: what for name, what in names.items() if what is not None}


def loaded(path):
    """A Folder with the content of a real folder, synced."""
    return Folder((p.name, loaded(p) if p.is_dir() else File(p.read_bytes())) for p in path.iterdir())


class Disk:
    """The files below `root`, initially those of the real disk."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.top = loaded(self.root)
        self.files = {}  # by inode; a reused inode is a new file

    def apply(self, operation):
        getattr(self, "do_" + operation.what)(operation)

    def find(self, path):
        """The File or Folder at an absolute path, or None."""
        here = self.top
        for part in pathlib.Path(path).relative_to(self.root).parts:
            here = here.now().get(part) if isinstance(here, Folder) else None
        return here

    def name(self, path, what):
        path = pathlib.Path(path)
        self.find(path.parent).pending.append({path.name: what})

    def do_make(self, op):
        self.files[op.inode] = File()

    def do_open(self, op):
        known = self.find(op.path)
        if known is None:
            self.name(op.path, known := File())
        self.files[op.inode] = known

    def do_write(self, op):
        self.files[op.inode].pending.append((op.offset, op.data))

    def do_truncate(self, op):
        self.files[op.inode].pending.append((op.offset, None))

    def do_link(self, op):
        self.name(op.path, self.files[op.inode])

    def do_rename(self, op):
        folder = self.find(pathlib.Path(op.path).parent)
        before = next(name for name, what in folder.now().items() if what is self.files[op.inode])
        folder.pending.append({before: None, pathlib.Path(op.path).name: self.files[op.inode]})

    def do_unlink(self, op):
        self.name(op.path, None)

    do_rmdir = do_unlink

    def do_mkdir(self, op):
        self.name(op.path, Folder())

    def do_sync(self, op):
        self.files[op.inode].sync()

    def do_syncdir(self, op):
        folder = self.find(op.path)
        if folder is not None:  # None if it has been removed
            folder.sync()

    def after_cut(self, random, folder=None, whole=None):
        """{name: bytes, or such a dict of a folder}: a random state after a power cut at this point.

        Some states lose all unsynced data, some lose none; in the others each file and folder has its own chance."""
        if folder is None:
            folder, whole = self.top, random.choice([0, 1, None, None, None])
        chance = lambda: random.choice([0, 0.1, 0.5, 0.9, 1]) if whole is None else whole
        return {name: self.after_cut(random, what, whole) if isinstance(what, Folder)
                else what.after_cut(chance(), random)
                for name, what in folder.names_after_cut(chance(), random).items()}


def write_state(state, folder):
    """Writes the files of a state to `folder`."""
    for name, what in state.items():
        if isinstance(what, dict):
            (folder / name).mkdir(mode=0o700)
            write_state(what, folder / name)
        else:
            (folder / name).write_bytes(what)
