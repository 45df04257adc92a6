#!/usr/bin/env python3
"""A reader of `.svdag` files, written from docs/format.md alone.

It checks everything that the page guarantees (sizes, checksums, content hash, masks, pointers, order,
minimality, counts, metadata) and lists the set voxels. It keeps all of them in memory: for small grids.

    read_svdag.py FILE             one line: resolution, voxels, SHA-256 of the sorted voxel list
    read_svdag.py FILE --voxels    the list itself, "x y z" per line, ascending
"""
import hashlib
import json
import struct
import sys

import numpy
import xxhash

BLOCK = 65536
HEADER = struct.Struct("<8s6I4d3q8IQd5Q")


class InvalidFile(Exception):
    pass


def demand(condition, sentence):
    if not condition:
        raise InvalidFile(sentence)


def aligned(offset):
    return (offset + 63) // 64 * 64


class Svdag:
    def __init__(self, data):
        demand(len(data) >= 1024, "shorter than a header")
        self.data = data
        self.read_header()
        self.check_layout()
        self.check_hashes()
        self.levels = [self.read_nodes(k) for k in range(self.L - 2)]
        self.bricks = numpy.frombuffer(self.section(self.L - 2), "<u8")
        self.check_graph()
        self.check_metadata()

    def read_header(self):
        fields = HEADER.unpack_from(self.data)
        (magic, self.version, size, self.L, self.F, self.rule, self.kind) = fields[:7]
        self.corner, self.voxel_size, self.k0 = list(fields[7:10]), fields[10], list(fields[11:14])
        self.bounded, count, self.selection = fields[14], fields[15], list(fields[16:22])
        (self.voxel_count, self.largest_snap, self.metadata_at, self.metadata_size, self.table_at,
         self.table_size, self.file_size) = fields[22:]
        demand(magic == b"\x89SVDAG\r\n", "not a .svdag file")
        demand(xxhash.xxh3_64_intdigest(self.data[:1016]) == struct.unpack_from("<Q", self.data, 1016)[0],
               "header checksum")
        demand((self.version, size) == (1, 1024), "version or header size")
        demand(3 <= self.L <= 20 and self.F == min(23, 39 - self.L), "L or F")
        demand(self.rule in (0, 1) and self.kind in (0, 1, 2) and self.bounded in (0, 1), "rule, kind or flag")
        demand(count == self.L - 1, "number of sections")
        self.entries = [struct.unpack_from("<3Q", self.data, 176 + 24 * k) for k in range(19)]
        demand(not any(map(any, self.entries[self.L - 1:])), "unused entries")
        demand(not any(self.data[648:744]) and not any(self.data[768:1016]), "reserved bytes")
        self.origin = list(struct.unpack_from("<3d", self.data, 744))
        demand(self.bounded or self.selection == [0, 0, 0] + [2**self.L] * 3, "selection")
        if self.kind != 0:
            demand(all(k % min(1024, 1 << self.L >> 1) == 0 for k in self.k0), "k0")
            planes = [(k + 0.5) * self.voxel_size for k in self.k0] if self.kind == 1 else \
                [o + k * self.voxel_size for o, k in zip(self.origin, self.k0)]
            demand(self.corner == planes, "corner")
        else:
            demand(self.k0 == [0, 0, 0], "k0")
        demand(self.kind == 2 or self.origin == [0, 0, 0], "origin")

    def check_layout(self):
        at, parts = 1024, [self.entries[k][:2] for k in range(self.L - 2, -1, -1)]
        for offset, size in parts + [(self.metadata_at, self.metadata_size), (self.table_at, self.table_size)]:
            demand(offset == aligned(at), "a section does not follow the previous one")
            demand(offset + size <= len(self.data), "a section ends beyond the end of the file")
            demand(not any(self.data[at:offset]), "padding is not zero")
            at = offset + size
        demand(at == self.file_size == len(self.data), "size of the file")

    def check_hashes(self):
        table = self.data[self.table_at:]
        body = self.data[1024:self.table_at]
        sums = [xxhash.xxh3_64_intdigest(body[i:i + BLOCK]) for i in range(0, len(body), BLOCK)]
        demand(table == struct.pack(f"<{len(sums)}Q", *sums), "block checksums")
        header = self.data[:632] + bytes(16) + self.data[648:1016] + bytes(8)
        digest = xxhash.xxh3_128_intdigest(header + table)
        demand(struct.unpack_from("<2Q", self.data, 632) == (digest & (2**64 - 1), digest >> 64), "content hash")

    def section(self, level):
        offset, size, _ = self.entries[level]
        return self.data[offset:offset + size]

    def read_nodes(self, level):
        """{first word: eight children, None where absent} of a level, in file order."""
        words = numpy.frombuffer(self.section(level), "<u4").tolist()
        nodes, at = {}, 0
        while at < len(words):
            mask = words[at]
            demand(0 < mask < 256, f"mask at word {at} of level {level}")
            demand(at + mask.bit_count() < len(words), f"level {level} ends inside a node")
            pointers = iter(words[at + 1:at + 1 + mask.bit_count()])
            nodes[at] = [next(pointers) if mask >> c & 1 else None for c in range(8)]
            at += 1 + mask.bit_count()
        demand(len(nodes) == self.entries[level][2], f"number of nodes of level {level}")
        return nodes

    def check_graph(self):
        demand(len(self.bricks) == self.entries[self.L - 2][2], "number of bricks")
        demand(bool(numpy.all(self.bricks != 0)) and bool(numpy.all(self.bricks[1:] > self.bricks[:-1])), "bricks")
        demand(len(self.levels[0]) == (len(self.bricks) > 0), "number of roots")
        below = [*self.levels[1:], dict.fromkeys(range(len(self.bricks)))]
        for level, (nodes, targets) in enumerate(zip(self.levels, below)):
            keys = [[0 if child is None else 1 + child for child in node] for node in nodes.values()]
            demand(all(a < b for a, b in zip(keys, keys[1:])), f"order of level {level}")
            used = {child for node in nodes.values() for child in node if child is not None}
            demand(used == set(targets), f"pointers of level {level}")

    def check_metadata(self):
        text = self.data[self.metadata_at:self.metadata_at + self.metadata_size].decode()
        demand(json.loads(text) == {
            "format": "svdag", "version": 1, "levels": self.L, "resolution": 2**self.L,
            "rule": ["conservative", "thin"][self.rule], "fraction_bits": self.F,
            "grid": {"kind": ["box", "lattice", "origin"][self.kind], "corner": self.corner,
                     "voxel_size": self.voxel_size, "k0": self.k0, "bounded": bool(self.bounded),
                     "selection": self.selection, **({"origin": self.origin} if self.kind == 2 else {})},
            "voxels": self.voxel_count, "nodes": [e[2] for e in self.entries[:self.L - 1]],
            "largest_snap": self.largest_snap}, "metadata")

    def voxels(self):
        """The set voxels as an array of (x, y, z), ascending."""
        found = []

        def descend(level, node, x, y, z):
            if level == self.L - 2:
                brick = int(self.bricks[node])
                for bit in range(64):
                    if brick >> bit & 1:
                        high, low = bit >> 3, bit & 7
                        found.append([4 * o + 2 * (high >> s & 1) + (low >> s & 1) for o, s in ((x, 2), (y, 1), (z, 0))])
                return
            for c, child in enumerate(self.levels[level][node]):
                if child is not None:
                    descend(level + 1, child, 2 * x + (c >> 2), 2 * y + (c >> 1 & 1), 2 * z + (c & 1))

        if len(self.bricks):
            descend(0, 0, 0, 0, 0)
        demand(len(found) == self.voxel_count, "number of voxels")
        low, high = self.selection[:3], self.selection[3:]
        demand(all(l <= a < h for v in found for l, a, h in zip(low, v, high)), "a voxel outside the selection")
        return numpy.array(sorted(found), "<u4").reshape(-1, 3)


def main():
    with open(sys.argv[1], "rb") as file:
        try:
            dag = Svdag(file.read())
            voxels = dag.voxels()
        except InvalidFile as problem:
            sys.exit(f"{sys.argv[1]}: {problem}")
    if "--voxels" in sys.argv[2:]:
        print("\n".join(f"{x} {y} {z}" for x, y, z in voxels))
    else:
        print(2**dag.L, len(voxels), hashlib.sha256(voxels.tobytes()).hexdigest())


if __name__ == "__main__":
    main()
