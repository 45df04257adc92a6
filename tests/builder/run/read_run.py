"""An independent reader of `.run` files, written from docs/run-format.md alone.

It checks every property that the page states and lists the set voxels. It holds all voxels in memory, so grids must be small.
"""
import struct

import xxhash

HEADER = struct.Struct("<8s6I4d3q8I3Qd21Q2Q")
BLOCK, FRAME = 65536, 64


class DamagedRun(Exception):
    pass


def require(condition, sentence):
    if not condition:
        raise DamagedRun(sentence)


def low_word(data):
    return xxhash.xxh3_128_intdigest(data) & (2**64 - 1)


class Run:
    def __init__(self, data):
        require(len(data) >= 1024, "shorter than a header")
        self.data = data
        self.read_header()
        self.read_blocks()
        self.read_sections()
        self.check_tops()

    def read_header(self):
        fields = HEADER.unpack_from(self.data)
        magic, version, size, self.L, F, rule, kind = fields[:7]
        block, self.range_count, self.number, self.voxel_count = fields[15], *fields[22:25]
        self.root_count, self.counts = fields[26], fields[27:46]
        file_size, self.content_hash = fields[46], fields[47:49]
        require(magic == b"\x89SVRUN\r\n" and (version, size, block) == (1, 1024, BLOCK), "magic, version or sizes")
        require(xxhash.xxh3_64_intdigest(self.data[:1016]) == struct.unpack_from("<Q", self.data, 1016)[0],
               "header checksum")
        require(3 <= self.L <= 20 and F == min(23, 39 - self.L) and rule in (0, 1) and kind in (0, 1, 2), "grid")
        require(not any(self.counts[self.L - 1:]) and not any(self.data[336:1016]), "unused fields")
        require(file_size == len(self.data), "size of the file")

    def read_blocks(self):
        """Concatenates the payloads; checks the frames and the content hash."""
        self.payload, sums = b"", b""
        for i, at in enumerate(range(1024, len(self.data), BLOCK)):
            block = self.data[at:at + BLOCK]
            magic, length, number, index, checksum = struct.unpack_from("<4sI3Q", block)
            require(magic == b"SVSP" and (number, index) == (self.number, i), "frame of a block")
            require(length == len(block) - FRAME and not any(block[32:64]), "length of a block")
            require(xxhash.xxh3_64_intdigest(block[:24] + bytes(8) + block[32:]) == checksum, "checksum of a block")
            self.payload += block[FRAME:]
            sums += block[24:32]
        blank = self.data[:320] + bytes(16) + self.data[336:1016] + bytes(8)
        digest = xxhash.xxh3_128_intdigest(sums + blank)
        require(self.content_hash == (digest & (2**64 - 1), digest >> 64), "content hash")

    def take(self, count, item):
        at = (self.at + 63) // 64 * 64
        require(not any(self.payload[self.at:at]), "a gap that is not zero")
        self.at = at + count * struct.calcsize(item)
        require(self.at <= len(self.payload), "a section ends after the payload")
        return list(struct.iter_unpack(item, self.payload[at:self.at]))

    def read_sections(self):
        self.at, self.levels = 0, {}
        for k in range(self.L - 2, -1, -1):
            keys = self.levels[k] = self.take(self.counts[k], "<Q" if k == self.L - 2 else "<8I")
            require(all(a < b for a, b in zip(keys, keys[1:])) and all(map(any, keys)), f"order of level {k}")
        self.roots = self.take(self.root_count, "<QII")
        begin = (self.at + 63) // 64 * 64
        self.ranges = self.take(self.range_count, "<QQ")
        require(self.at == len(self.payload), "bytes after the ranges")
        require(low_word(self.data[:128] + self.payload[begin:]) == self.number, "number of the run")
        for k in range(self.L - 1):
            used = {rank for _, level, rank in self.roots if level == k}
            if k > 0:
                used |= {child - 1 for key in self.levels[k - 1] for child in key if child}
            require(used == set(range(self.counts[k])), f"nodes of level {k} that are reached")

    def tops(self, level=0, code=0):
        """(code, level) of the maximal cubes in the ranges, in Morton order."""
        size = 8 ** (self.L - level)
        begin, end = code * size, (code + 1) * size
        if any(b <= begin and end <= e for b, e in self.ranges):
            yield code, level
        elif any(b < end and begin < e for b, e in self.ranges):
            for c in range(8):
                yield from self.tops(level + 1, 8 * code + c)

    def check_tops(self):
        tops = list(self.tops())
        named = [(code, level) for code, level, _ in self.roots]
        require(named == [top for top in tops if top in set(named)], "roots are tops, in order")

    def codes(self):
        """The Morton codes of the set voxels, ascending. The bit number in a brick, 8 c1 + c2, is a Morton code."""
        found = []

        def descend(level, rank, code):
            if level == self.L - 2:
                brick, = self.levels[level][rank]
                found.extend(64 * code + bit for bit in range(64) if brick >> bit & 1)
                return
            for c, child in enumerate(self.levels[level][rank]):
                if child:
                    descend(level + 1, child - 1, 8 * code + c)

        for code, level, rank in self.roots:
            descend(level, rank, code)
        require(len(found) == self.voxel_count and found == sorted(set(found)), "number of voxels")
        return found
