"""Polygons into triangles, with the rules of io/scene/polygons/triangulate.h: a fan from the first corner if the polygon is
convex, else ears clipped in the same order, in the mesh's own space.

Triangles are returned as corners (positions in the list of vertex indices), so that values per corner follow them.
"""
import numpy as np

_CHUNK = 1 << 18  # polygons held in double at once


def triangulate(points, counts, indices):
    """Corners (m, 3) and faces (m,) of the triangles, in the order of the faces. Fewer than three corners give none."""
    starts = np.zeros(len(counts), np.int64)
    np.cumsum(counts[:-1], out=starts[1:])
    corners, faces = [], []
    for n in np.unique(counts[counts >= 3]):
        of_n = np.flatnonzero(counts == n)
        for i in range(0, len(of_n), _CHUNK):
            chunk = of_n[i:i + _CHUNK]
            polygons = starts[chunk][:, None] + np.arange(n)
            if n == 3:
                corners.append(polygons)
                faces.append(chunk)
                continue
            flat, has_area = _project(points[indices[polygons]].astype(np.float64))
            fan = ~has_area | _surely_convex(flat)
            rows = polygons[fan]
            fans = np.stack([np.repeat(rows[:, :1], n - 2, 1), rows[:, 1:-1], rows[:, 2:]], -1)
            corners.append(fans.reshape(-1, 3))
            faces.append(np.repeat(chunk[fan], n - 2))
            for k in np.flatnonzero(~fan):
                ring = _Ring(flat[k])
                corners.append(polygons[k][np.array(ring.triangles(), np.int64)])
                faces.append(np.full(n - 2, chunk[k]))
    if not corners:
        return np.zeros((0, 3), np.int64), np.zeros(0, np.int64)
    if len(corners) == 1:
        return corners[0], faces[0]
    face = np.concatenate(faces)
    order = np.argsort(face, kind="stable")
    return np.concatenate(corners)[order], face[order]


def _project(points):
    """Polygons (k, n, 3) along the dominant axis of their Newell normals, counter-clockwise; and whether they have an area."""
    b = points - points[:, :1]
    a = np.roll(b, 1, 1)
    normal = np.stack([((a[..., (i + 1) % 3] - b[..., (i + 1) % 3]) * (a[..., (i + 2) % 3] + b[..., (i + 2) % 3])).sum(1)
                       for i in range(3)], -1)
    axis = np.abs(normal).argmax(1)
    along = np.take_along_axis(normal, axis[:, None], 1)[:, 0]
    u, v = (axis + 1) % 3, (axis + 2) % 3
    u, v = np.where(along < 0, v, u), np.where(along < 0, u, v)
    flat = np.stack([np.take_along_axis(points, each[:, None, None], 2)[..., 0] for each in (u, v)], -1)
    return flat, np.abs(along) > 0


def _surely_convex(flat):
    """No right turn and once around. A polygon that repeats a corner is left to the ring, whose triangles cover it as well."""
    edge = np.roll(flat, -1, 1) - flat
    after = np.roll(edge, -1, 1)
    left = edge[..., 0] * after[..., 1] - edge[..., 1] * after[..., 0] >= 0
    half = (edge[..., 1] > 0) | ((edge[..., 1] == 0) & (edge[..., 0] > 0))
    once = (half != np.roll(half, 1, 1)).sum(1) == 2
    return left.all(1) & once & (edge != 0).any(2).all(1)


class _Ring:
    """The corners that are not clipped yet; methods are those of Triangulator."""

    def __init__(self, flat):
        n = len(flat)
        self.flat = flat
        self.at = [tuple(p) for p in flat.tolist()]
        self.prev = [(i - 1) % n for i in range(n)]
        self.next = [(i + 1) % n for i in range(n)]
        self.in_ring = np.ones(n, bool)
        self.left = n
        self.candidates = set(range(n))
        self.waiting = {}  # by the corner that forbids them
        self.out = []

    def turn(self, a, b, c):
        (ax, ay), (bx, by), (cx, cy) = self.at[a], self.at[b], self.at[c]
        return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)

    def turns(self, a, b):
        (ax, ay), (bx, by) = self.at[a], self.at[b]
        return (bx - ax) * (self.flat[:, 1] - ay) - (by - ay) * (self.flat[:, 0] - ax)

    def forbids(self, i, a, b, c):
        def inside(start, right, left):
            return any(self.turn(start, right, to) > 0 and self.turn(start, to, left) > 0 for to in (self.prev[i], self.next[i]))
        p = self.at[i]
        if p == self.at[a]:
            return inside(a, b, c)
        if p == self.at[b]:
            return inside(b, c, a)
        if p == self.at[c]:
            return inside(c, a, b)
        for s, e in ((a, b), (b, c)):
            if self.turn(s, e, i) == 0:
                return any(self.turn(s, e, to) > 0 for to in (self.prev[i], self.next[i]))
        return True

    def is_ear(self, ear):
        a, c = self.prev[ear], self.next[ear]
        self.candidates.discard(ear)
        if not self.turn(a, ear, c) > 0:
            return False
        near = self.in_ring & (self.turns(a, ear) >= 0) & (self.turns(ear, c) >= 0) & (self.turns(c, a) >= 0)
        for i in np.flatnonzero(near).tolist():
            if i not in (a, ear, c) and self.forbids(i, a, ear, c):
                self.waiting.setdefault(i, []).append(ear)
                return False
        return True

    def next_ear(self, start):
        later = sorted(self.candidates)
        for i in [i for i in later if i >= start] + [i for i in later if i < start]:
            if self.is_ear(i):
                return i
        return None

    def wake(self, corner):
        self.candidates.update(i for i in self.waiting.pop(corner, ()) if self.in_ring[i])

    def clip(self, corner):
        a, c = self.prev[corner], self.next[corner]
        self.out.append((a, corner, c))
        self.next[a], self.prev[c] = c, a
        self.left -= 1
        self.in_ring[corner] = False
        self.candidates.discard(corner)
        self.candidates.update((a, c))
        for each in (corner, a, c):
            self.wake(each)
        return a

    def clip_slit(self, corner):
        while self.left > 3 and self.at[self.prev[corner]] == self.at[self.next[corner]]:
            corner = self.clip(corner)
            if self.left > 3:
                self.clip(self.next[corner])
        return corner

    def triangles(self):
        for i in range(len(self.at)):
            if self.left > 3 and self.at[i] == self.at[self.prev[i]]:
                self.clip(i)
        here = min(self.candidates)
        for _ in range(self.left):
            here = self.next[self.clip_slit(here)]
        while self.left > 3:
            ear = self.next_ear(here)
            if ear is None:
                break
            a = self.clip_slit(self.clip(ear))
            here = self.next[self.clip_slit(self.next[a])]
        i = self.next[here]
        while self.next[i] != here:
            self.out.append((here, i, self.next[i]))
            i = self.next[i]
        return self.out
