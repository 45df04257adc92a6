"""What a disk may hold after a power cut: the log of log.h, replayed up to any operation.

A file holds what was synced. Of the writes and cuts after its last sync any may be there, writes in part (in blocks
of 4 KiB), and a file that grew may be zeros where nothing arrived. A folder has the names that it had when it was
synced; of those made, replaced and removed since then any may be there, each for itself, which is more than file
systems with a journal allow. After leveldb's fault injection and ALICE (Pillai et al., OSDI 2014).
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
    """The operations of a log, which is bytes."""
    found, at = [], 0
    while at < len(log):
        end = log.index(b"\n", at)
        what, inode, offset, size, path = log[at:end].decode().split(" ", 4)
        at = end + 1 + int(size)
        found.append(Operation(what, int(inode), int(offset), path.removesuffix(" (deleted)"), log[end + 1:at]))
    return found


def written(content, offset, data):
    content.extend(bytes(max(0, offset + len(data) - len(content))))
    content[offset:offset + len(data)] = data


def cut(content, size):
    content.extend(bytes(max(0, size - len(content))))
    del content[size:]


class File:
    def __init__(self, content=b""):
        self.durable = bytearray(content)
        self.pending = []  # (offset, data), or (size, None) of a cut
        self.syncs = 0

    def change(self, content, kept=lambda: True):
        for offset, data in self.pending:
            if data is None:
                if kept():
                    cut(content, offset)
                continue
            begin = offset
            while begin < offset + len(data):
                end = min(offset + len(data), (begin // BLOCK + 1) * BLOCK)
                if kept():
                    written(content, begin, data[begin - offset:end - offset])
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
        if random.random() < 0.5:  # the size arrived, what it counts did not
            cut(content, max(len(content), len(self.now())))
        return bytes(content)


class Folder:
    def __init__(self, names=()):
        self.durable = dict(names)
        self.pending = []  # {name: File, Folder or None}: what one operation changes

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
    """A folder of the real disk, as one that is synced."""
    return Folder((p.name, loaded(p) if p.is_dir() else File(p.read_bytes())) for p in path.iterdir())


class Disk:
    """The files below `root`, which it reads when it is made."""

    def __init__(self, root):
        self.root = pathlib.Path(root)
        self.top = loaded(self.root)
        self.files = {}  # by inode; an inode that is used again is another file

    def apply(self, operation):
        getattr(self, "do_" + operation.what)(operation)

    def find(self, path):
        """What has this path now, or None; the path is from the root of the real disk."""
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
        if folder is not None:  # else it was removed meanwhile
            folder.sync()

    def after_cut(self, random, folder=None, whole=None):
        """{name: bytes, or the same of a folder}: one of the states that a power cut now may leave.

        Some states lose all that was not synced, some lose nothing; else every file and folder has its own luck."""
        if folder is None:
            folder, whole = self.top, random.choice([0, 1, None, None, None])
        chance = lambda: random.choice([0, 0.1, 0.5, 0.9, 1]) if whole is None else whole
        return {name: self.after_cut(random, what, whole) if isinstance(what, Folder)
                else what.after_cut(chance(), random)
                for name, what in folder.names_after_cut(chance(), random).items()}


def lay(state, folder):
    """Makes the state real."""
    for name, what in state.items():
        if isinstance(what, dict):
            (folder / name).mkdir(mode=0o700)
            lay(what, folder / name)
        else:
            (folder / name).write_bytes(what)
