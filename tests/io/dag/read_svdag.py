#!/usr/bin/env python3
"""A reader of `.svdag` files, written from docs/format.md alone.

It checks everything that the page guarantees (sizes, checksums, content hash, masks, pointers, order,
minimality, counts, layers, colours, metadata) and lists the set voxels and colours. It keeps all of them in memory: for small grids.

    read_svdag.py FILE             one line: resolution, voxels, SHA-256 of the sorted voxel list
    read_svdag.py FILE --voxels    the list itself, "x y z" per line, ascending
"""
import functools
import hashlib
import json
import re
import struct
import sys
import typing

import numpy
import xxhash

BLOCK = 65536
HEADER = struct.Struct("<8s6I4d3q8IQd5Q")


class InvalidFile(Exception):
    pass


class Layer(typing.NamedTuple):
    name: bytes
    colour: tuple  # red, green, blue
    voxels: int
    root: int | None  # key of level 0


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
        self.bricks = numpy.frombuffer(self.section(self.L - 2), "<u8")
        read = self.read_compact_nodes if self.compact else self.read_nodes
        self.levels = [read(k) for k in range(self.L - 2)]
        self.read_layers()
        self.check_graph()
        self.check_metadata()
        self.read_colours()
        self.check_layer_voxels()

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
        self.compact, zero = struct.unpack_from("<2I", self.data, 768)
        self.layers_at, self.layers_size, self.layer_count, self.layer_kind, self.has_union, zero_2 = \
            struct.unpack_from("<2Q4I", self.data, 792)
        (self.chunks_at, self.chunks_size, self.directory_at, self.directory_size, self.colour_count, self.K,
         self.colour_error) = struct.unpack_from("<5Q2I", self.data, 824)
        demand(self.K or not any(self.data[824:888]), "colours of a file without")
        demand(self.K <= self.L and self.colour_error <= 255 * 256, "level or error of the colours")
        version = 3 if self.K else 2 if self.compact or self.layer_kind else 1
        demand(self.compact in (0, 1) and (self.version, size, zero) == (version, 1024, 0), "version, size or layout")
        demand(self.layer_kind in (0, 1, 2, 3, 4) and self.has_union in (0, 1) and zero_2 == 0, "layers")
        demand(self.layer_kind or not any(self.data[792:824]), "layers of a file without")
        demand(3 <= self.L <= 20 and self.F == min(23, 39 - self.L), "L or F")
        demand(self.rule in (0, 1, 2, 3, 4) and self.kind in (0, 1, 2) and self.bounded in (0, 1), "rule, kind or flag")
        demand(count == self.L - 1, "number of sections")
        self.entries = [struct.unpack_from("<3Q", self.data, 176 + 24 * k) for k in range(19)]
        demand(not any(map(any, self.entries[self.L - 1:])), "unused entries")
        demand(not any(self.data[648:744]) and not any(self.data[888:1016]), "reserved bytes")
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
        order = range(self.L - 1) if self.compact else range(self.L - 2, -1, -1)
        at, parts = 1024, [self.entries[k][:2] for k in order]
        if self.layer_kind:
            parts.append((self.layers_at, self.layers_size))
        self.geometry_end = sum(parts[-1])
        if self.K:
            parts += [(self.chunks_at, self.chunks_size), (self.directory_at, self.directory_size)]
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
        of_table = self.compact or self.K
        digest = xxhash.xxh3_128_intdigest(table if of_table else header + table)
        hashed = struct.unpack_from("<2Q", self.data, 776 if of_table else 632)
        demand(hashed == (digest & (2**64 - 1), digest >> 64), "content hash")
        demand(of_table or not any(self.data[776:792]), "reserved bytes")

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

    def read_compact_nodes(self, level):
        """{number: eight children, None where absent} of a level in the compact layout."""
        data, count = self.section(level), self.entries[level][2]
        if count == 0:
            demand(data == b"", "an empty level")
            return {}
        entry = struct.unpack_from("<8I4Q", data)
        kind, widths, sizes, references = entry[0], entry[1:4], entry[4:7], entry[8:11]
        demand(kind in (0, 1) and entry[7] == entry[11] == 0, f"entry of level {level}")
        demand(sum(sizes) == self.entries[level + 1][2], f"classes of level {level}")
        lines = -(-count // 32)
        bases_at = 64 + 64 * lines
        at = aligned(bases_at + 12 * lines)
        demand(not any(data[bases_at + 12 * lines:at]), f"padding of level {level}")
        values = []
        for s in range(3):
            if kind == 0 and s == 0:
                demand(widths[0] == 0 and references[0] == sizes[0], f"private nodes of level {level}")
                values.append(iter(range(sizes[0])))
                continue
            demand(widths[s] == (sizes[s] - 1).bit_length() * (sizes[s] > 0), f"width of class {s} of level {level}")
            used = -(-references[s] * widths[s] // 8)
            bits = int.from_bytes(data[at:at + used], "little")
            demand(bits >> references[s] * widths[s] == 0, f"padding of level {level}")
            values.append(iter([bits >> t * widths[s] & (1 << widths[s]) - 1 for t in range(references[s])]))
            end = at + aligned(used + 8)
            demand(not any(data[at + used:end]), f"padding of level {level}")
            at = end
        demand(at == len(data), f"size of level {level}")
        nodes, found, first = {}, [0, 0, 0], (0, sizes[0], sizes[0] + sizes[1])
        for i in range(32 * lines):
            line = 64 + 64 * (i // 32)
            if i % 32 == 0:
                demand(list(struct.unpack_from("<3I", data, bases_at + 12 * (i // 32))) == found, f"bases of level {level}")
            m0, m1 = data[line + i % 32], data[line + 32 + i % 32]
            demand((m0 | m1 != 0) == (i < count), f"mask of node {i} of level {level}")
            children = [None] * 8
            for c in range(8):
                state = (m0 >> c & 1) + 2 * (m1 >> c & 1)
                if state:
                    found[state - 1] += 1
                    value = next(values[state - 1], None)
                    demand(value is not None and value < sizes[state - 1], f"reference of level {level}")
                    children[c] = first[state - 1] + value
            if i < count:
                nodes[i] = children
        demand(found == list(references), f"references of level {level}")
        self.check_classes(level, nodes, kind, sizes)
        return nodes

    def check_classes(self, level, nodes, kind, sizes):
        """Classes by the number of references; how many are in B, and in A of kind 1, is not checked."""
        count = [0] * sum(sizes)
        for node in nodes.values():
            for child in node:
                if child is not None:
                    count[child] += 1
        a, b = sizes[0], sizes[0] + sizes[1]
        classes = [count[:a], count[a:b], count[b:]]
        demand(all(count), f"a node below level {level} that no node uses")
        if kind == 0:
            demand(all(n == 1 for n in classes.pop(0)) and all(n > 1 for part in classes for n in part), f"class A of level {level}")
        for more, fewer in zip(classes, classes[1:]):
            demand(not more or not fewer or min(more) >= max(fewer), f"the most referenced nodes of level {level}")

    def read_layers(self):
        """self.layers, in the order of the table."""
        table = self.data[self.layers_at:self.layers_at + self.layers_size]
        roots, self.layers, at = list(self.levels[0]), [], 24 * self.layer_count
        demand(at <= len(table) and self.layer_count <= 65535, "layer table")
        for i in range(self.layer_count):
            voxels, root, size, *colour = struct.unpack_from("<Q2I8B", table, 24 * i)
            demand(not any(colour[3:]) and at + size <= len(table), "entry of the layer table")
            demand((voxels == 0) == (root == 0xffffffff) and (voxels == 0 or root < len(roots)), "root of a layer")
            self.layers.append(Layer(table[at:at + size], tuple(colour[:3]), voxels, roots[root] if voxels else None))
            at += size
        names = [layer.name for layer in self.layers]
        demand(at == len(table) and names == sorted(set(names)), "names of layers")
        used = [layer.root for layer in self.layers if layer.voxels]
        if self.layer_kind and not self.has_union:
            demand(used[:1] == roots[:1], "the first root")
        if self.layer_kind == 0 or self.has_union:
            used += roots[:1]
        demand(set(used) == set(roots), "a root that no layer has")

    def plain_form(self):
        """The bytes of a compact file in the plain layout."""
        sections, index = [], {}
        for k in range(self.L - 2, -1, -1):
            if k == self.L - 2:
                order = sorted((int(brick), i) for i, brick in enumerate(self.bricks))
                index = {i: n for n, (_, i) in enumerate(order)}
                sections.append(b"".join(struct.pack("<Q", brick) for brick, _ in order))
                continue
            keys = [([0 if c is None else 1 + index[c] for c in node], i) for i, node in self.levels[k].items()]
            if k > 0:  # roots stay in their order
                keys.sort()
            words, index = [], {}
            for key, i in keys:
                index[i] = len(words)
                words += [sum(1 << c for c in range(8) if key[c])] + [n - 1 for n in key if n]
            sections.append(struct.pack(f"<{len(words)}I", *words))
        header, body = bytearray(self.data[:1024]), bytearray()
        header[768:792] = bytes(24)

        def place(part):
            body.extend(bytes(aligned(len(body)) - len(body)))
            offset = 1024 + len(body)
            body.extend(part)
            return offset
        for k, part in zip(range(self.L - 2, -1, -1), sections):
            struct.pack_into("<3Q", header, 176 + 24 * k, place(part), len(part), self.entries[k][2])
        if self.layer_kind:
            struct.pack_into("<Q", header, 792, place(self.data[self.layers_at:self.layers_at + self.layers_size]))
        return self.finished(header, body, compact=False)

    def without_colours(self):
        header = bytearray(self.data[:776]) + bytes(16) + self.data[792:824] + bytes(64) + self.data[888:1024]
        return self.finished(header, bytearray(self.data[1024:self.geometry_end]), self.compact)

    def finished(self, header, body, compact):
        """A file without colours: its metadata, checksums and hashes after `body`."""
        def place(part):
            body.extend(bytes(aligned(len(body)) - len(body)))
            offset = 1024 + len(body)
            body.extend(part)
            return offset
        version = 2 if compact or self.layer_kind else 1
        struct.pack_into("<I", header, 8, version)
        text = self.data[self.metadata_at:self.metadata_at + self.metadata_size]
        text = re.sub(rb',"colours":[{][^}]*[}]', b"", text)
        text = re.sub(rb'"version":[0-9](,"layout":"compact")?', b'"version":%d%s' % (version, b',"layout":"compact"' if compact else b""), text)
        at = place(text)
        place(b"")
        table = b"".join(struct.pack("<Q", xxhash.xxh3_64_intdigest(bytes(body[i:i + BLOCK]))) for i in range(0, len(body), BLOCK))
        struct.pack_into("<5Q", header, 136, at, len(text), 1024 + len(body), len(table), 1024 + len(body) + len(table))
        if not compact:
            header[632:648] = bytes(16)
        header[1016:] = bytes(8)
        digest = xxhash.xxh3_128_intdigest(table if compact else bytes(header) + table)
        struct.pack_into("<2Q", header, 776 if compact else 632, digest & (2**64 - 1), digest >> 64)
        struct.pack_into("<Q", header, 1016, xxhash.xxh3_64_intdigest(bytes(header[:1016])))
        return bytes(header + body + table)

    def check_graph(self):
        if self.K:
            bare = Svdag(self.without_colours())  # checks the rest
            demand(bare.data[632:648] == self.data[632:648], "content hash of the file without colours")
            return
        if self.compact:
            plain = Svdag(self.plain_form())  # checks order and minimality
            demand(plain.data[632:648] == self.data[632:648], "content hash of the plain file")
            return
        demand(len(self.bricks) == self.entries[self.L - 2][2], "number of bricks")
        demand(bool(numpy.all(self.bricks != 0)) and bool(numpy.all(self.bricks[1:] > self.bricks[:-1])), "bricks")
        demand(self.layer_kind or len(self.levels[0]) == (len(self.bricks) > 0), "number of roots")
        below = [*self.levels[1:], dict.fromkeys(range(len(self.bricks)))]
        for level, (nodes, targets) in enumerate(zip(self.levels, below)):
            keys = [[0 if child is None else 1 + child for child in node] for node in nodes.values()]
            first = 1 if level == 0 else 0  # the first root is in no order
            demand(all(a < b for a, b in zip(keys[first:], keys[first + 1:])), f"order of level {level}")
            demand(len({tuple(key) for key in keys}) == len(keys), f"equal nodes of level {level}")
            used = {child for node in nodes.values() for child in node if child is not None}
            demand(used == set(targets), f"pointers of level {level}")

    def check_metadata(self):
        text = self.data[self.metadata_at:self.metadata_at + self.metadata_size].decode()
        demand(json.loads(text) == {
            "format": "svdag", "version": self.version, **({"layout": "compact"} if self.compact else {}), "levels": self.L, "resolution": 2**self.L,
            "rule": ["conservative", "thin", "solid", "solid-odd", "points"][self.rule], "fraction_bits": self.F,
            "grid": {"kind": ["box", "lattice", "origin"][self.kind], "corner": self.corner,
                     "voxel_size": self.voxel_size, "k0": self.k0, "bounded": bool(self.bounded),
                     "selection": self.selection, **({"origin": self.origin} if self.kind == 2 else {})},
            "voxels": self.voxel_count, "nodes": [e[2] for e in self.entries[:self.L - 1]],
            "largest_snap": self.largest_snap,
            **({"layers": {"kind": ["", "object", "material", "file", "frame"][self.layer_kind], "count": self.layer_count,
                           "union": bool(self.has_union)}} if self.layer_kind else {}),
            **({"colours": {"level": self.K, "error": self.colour_error / 256, "count": self.colour_count}} if self.K else {})}, "metadata")

    def read_colours(self):
        """self.colours: {(level, x, y, z): "rrggbb"} of all cubes that have one."""
        self.colours = {}
        if not self.K:
            return
        chunks = self.data[self.chunks_at:self.chunks_at + self.chunks_size]
        directory = self.data[self.directory_at:self.directory_at + self.directory_size]
        digest = xxhash.xxh3_128_intdigest(self.data[856:872] + chunks + directory)
        demand(struct.unpack_from("<2Q", self.data, 872) == (digest & (2**64 - 1), digest >> 64), "colour hash")
        demand(not self.layer_kind or self.has_union, "colours of a file without union")
        entries = list(struct.iter_unpack("<2Q", directory))
        ends = [first for first, _ in entries[1:]] + [self.colour_count]
        places = [value - 2**63 for _, value in entries if value >> 63] + [len(chunks) // 4]
        demand(places[0] == 0 if entries and len(places) > 1 else not chunks, "the first chunk")
        self.spans, stream, chunk = [], [], 0
        for (first, value), end in zip(entries, ends):
            demand(first == len(stream) < end, "numbers of colours")
            self.spans.append((end - first, value >> 63))
            if value >> 63:
                demand(end - first <= 16384 and places[chunk] < places[chunk + 1], "a chunk")
                stream += decode_chunk(chunks[4 * places[chunk]:4 * places[chunk + 1]], end - first)
                chunk += 1
            else:
                demand(value < 2**24 or value == 0xffffffff, "a colour")
                stream += [value] * (end - first)
        demand(len(stream) == self.colour_count, "number of colours")
        self.place_colours(stream)

    def covered_children(self, level, node):
        """(c, child) of a node, brick, or octant of a brick; the latter two are given by their bits."""
        if level < self.L - 2:
            for c, child in enumerate(self.levels[level][node]):
                if child is not None:
                    yield c, int(self.bricks[child]) if level == self.L - 3 else child
        else:
            for c in range(8):
                bits = node >> 8 * c & 255 if level == self.L - 2 else node >> c & 1
                if bits:
                    yield c, bits

    def place_colours(self, stream):
        colours, spans = iter(stream), list(reversed(self.spans))

        @functools.lru_cache(maxsize=None)
        def count(level, node):
            if level == self.K:
                return 1
            return (self.K - level + 1) % 2 + sum(count(level + 1, child) for _, child in self.covered_children(level, node))

        def show(level, x, y, z):
            colour = next(colours, None)
            demand(colour is not None, "fewer colours than cubes")
            if colour != 0xffffffff:
                self.colours[level, x, y, z] = colour.to_bytes(3, "little").hex()

        def descend(level, node, x, y, z, in_entry):
            if not in_entry:
                in_entry = spans[-1:] and spans[-1][0] == count(level, node)
                if in_entry:
                    spans.pop()
                else:
                    demand(count(level, node) > 16384, "an entry that is not of a cube")
                    demand((self.K - level) % 2 or spans and spans.pop() == (1, 0), "an entry that is not a cube's mean")
            if (self.K - level) % 2 == 0:
                show(level, x, y, z)
            if level < self.K:
                for c, child in self.covered_children(level, node):
                    descend(level + 1, child, 2 * x + (c >> 2), 2 * y + (c >> 1 & 1), 2 * z + (c & 1), in_entry)

        if self.levels[0]:
            descend(0, next(iter(self.levels[0])), 0, 0, 0, False)
        demand(next(colours, None) is None and not spans, "more colours than cubes")

    def check_layer_voxels(self):
        """Each layer's number of voxels and selection; the union of rules conservative and thin is that of the layers."""
        found = [self.voxels(i) for i in range(len(self.layers))]
        if self.layer_kind and self.has_union and self.rule not in (2, 3):
            together = {tuple(voxel) for voxels in found for voxel in voxels.tolist()}
            demand({tuple(voxel) for voxel in self.voxels().tolist()} == together, "the union is not that of the layers")

    def voxels(self, layer=None):
        """The set voxels as an array of (x, y, z), ascending: of the first root, or of self.layers[layer]."""
        root, count = (next(iter(self.levels[0]), None), self.voxel_count) if layer is None else \
            (self.layers[layer].root, self.layers[layer].voxels)
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

        if root is not None:
            descend(0, root, 0, 0, 0)
        demand(len(found) == count, "number of voxels")
        low, high = self.selection[:3], self.selection[3:]
        demand(all(l <= a < h for v in found for l, a, h in zip(low, v, high)), "a voxel outside the selection")
        return numpy.array(sorted(found), "<u4").reshape(-1, 3)


def decode_chunk(data, count):
    """The colours of a chunk, 0xffffffff for none."""
    demand(len(data) >= 4, "a chunk without runs")
    runs, = struct.unpack_from("<I", data)
    groups = -(-runs // 16)
    header_at = 4 + 4 * groups
    payload_at = header_at + 4 * (-(-11 * runs // 32))
    demand(0 < runs <= 16384 and payload_at <= len(data), "headers of a chunk")
    headers = int.from_bytes(data[header_at:payload_at], "little")
    payload = int.from_bytes(data[payload_at:], "little")
    demand(headers >> 11 * runs == 0, "padding of a chunk")
    colours, at = [], 0

    def read(bits):
        nonlocal at
        at += bits
        return payload >> at - bits & (1 << bits) - 1
    for run in range(runs):
        if run % 16 == 0:
            at += at % 2
            group, = struct.unpack_from("<I", data, 4 + 4 * (run // 16))
            demand((group & 16383, group >> 14) == (len(colours), at // 2), "group of a chunk")
        header = headers >> 11 * run & 2047
        length, kind = 1 + (header & 255), header >> 8
        if kind == 7:
            colours += [0xffffffff] * length
        elif kind == 6:
            colours += [read(24) for _ in range(length)]
        elif kind < 2:
            colours += [read(24)] * (length * (256 if kind == 1 else 1))
        else:
            last = (1 << kind - 1) - 1
            a, b = ([(v << 2 | v >> 4) for v in (read(6), read(6), read(6))] for _ in range(2))
            for _ in range(length):
                w = read(kind - 1)
                mixed = [(p * (last - w) + q * w + last // 2) // last for p, q in zip(a, b)]
                colours.append(mixed[0] | mixed[1] << 8 | mixed[2] << 16)
        demand(len(colours) <= count, "a run beyond its chunk")
    demand(len(colours) == count, "number of colours of a chunk")
    demand(len(data) == payload_at + 4 * (-(-at // 32)) and payload >> at == 0, "size of a chunk")
    return colours


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
