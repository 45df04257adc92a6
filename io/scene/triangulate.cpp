#include "io/scene/triangulate.h"

#include <algorithm>
#include <cmath>

#include "streaming/error.h"

namespace svdag {
namespace {

// Clipping is quadratic, cubic at worst; a polygon may take this many point tests per corner, what
// is left then becomes a fan. Reached only by polygons of thousands of corners.
constexpr uint64_t kWorkPerCorner = 1 << 14;

// Sum over the edges, from the first corner so that large offsets cost no digits.
Point newell_normal(const std::vector<Point>& corners) {
  Point normal(0.0);
  Point a = corners.back() - corners.front();
  for (const Point& corner : corners) {
    const Point b = corner - corners.front();
    normal.x += (a.y - b.y) * (a.z + b.z);
    normal.y += (a.z - b.z) * (a.x + b.x);
    normal.z += (a.x - b.x) * (a.y + b.y);
    a = b;
  }
  return normal;
}

int dominant_axis(const Point& v) {
  int axis = 0;
  for (int a = 1; a < 3; ++a) {
    if (std::abs(v[a]) > std::abs(v[axis])) axis = a;
  }
  return axis;
}

// The half plane of a direction: 1 for angles in [0, pi), 0 for [pi, 2 pi), -1 for no direction.
int half(const glm::dvec2& d) {
  if (d.x == 0 && d.y == 0) return -1;
  return d.y > 0 || (d.y == 0 && d.x > 0) ? 1 : 0;
}

}  // namespace

void Triangulator::grow() {
  const size_t capacity = std::max<size_t>(64, 2 * corners_.capacity());
  if (capacity > UINT32_MAX) throw Error(ExitCode::kBadInput, "a polygon has too many corners");
  // The corners, half of them once more while they are moved, their projection and the ring.
  const size_t bytes = sizeof(Point) * 3 / 2 + sizeof(glm::dvec2) + 2 * sizeof(uint32_t);
  reservation_.resize(capacity * bytes, kPurpose);
  corners_.reserve(capacity);
}

void Triangulator::finish(BatchWriter& writer) {
  if (corners_.size() > 3 && project() && !is_convex()) {
    clip_ears(writer);
  } else {
    fan(writer);
  }
  corners_.clear();
}

void Triangulator::fan(BatchWriter& writer) const {
  for (size_t i = 2; i < corners_.size(); ++i)
    writer.add(corners_[0], corners_[i - 1], corners_[i]);
}

// Fills flat_; false if the polygon has no area to speak of (or is not finite).
bool Triangulator::project() {
  const Point normal = newell_normal(corners_);
  const int axis = dominant_axis(normal);
  if (!(std::abs(normal[axis]) > 0)) return false;
  int u = (axis + 1) % 3, v = (axis + 2) % 3;
  if (normal[axis] < 0) std::swap(u, v);
  flat_.clear();
  flat_.reserve(corners_.capacity());
  for (const Point& p : corners_) flat_.push_back({p[u], p[v]});
  return true;
}

// Twice the signed area of the projected triangle: positive for a left turn.
double Triangulator::turn(size_t a, size_t b, size_t c) const {
  const glm::dvec2 ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a];
  return ab.x * ac.y - ab.y * ac.x;
}

// No right turn, and once around only: a pentagram turns left everywhere, but goes around twice.
bool Triangulator::is_convex() const {
  const size_t n = flat_.size();
  int changes = 0, first = -1, last = -1;
  for (size_t i = 0; i < n; ++i) {
    const size_t j = i + 1 < n ? i + 1 : 0, k = j + 1 < n ? j + 1 : 0;
    if (!(turn(i, j, k) >= 0)) return false;
    const int side = half(flat_[j] - flat_[i]);
    if (side < 0) continue;
    if (first < 0) first = side;
    if (last >= 0 && side != last) ++changes;
    last = side;
  }
  if (first != last) ++changes;
  return changes == 2;
}

// Whether the way from corner `from` to corner `to` of the ring leads into the triangle at once;
// left and right: the other two corners of the triangle, as seen from `from`.
bool Triangulator::leads_inside(size_t from, size_t right, size_t left, size_t to) const {
  return turn(from, right, to) > 0 && turn(from, to, left) > 0;
}

// Whether corner i of the ring forbids the ear a, b, c: it lies in the closed triangle, and if it
// only touches the outline there (one of its corners, the edge a-b or b-c), one of its own edges
// leads inside. In a simple polygon no corner touches anything.
bool Triangulator::forbids(uint32_t i, size_t a, size_t b, size_t c) const {
  const double ab = turn(a, b, i);
  if (!(ab >= 0)) return false;
  const double bc = turn(b, c, i);
  if (!(bc >= 0 && turn(c, a, i) >= 0)) return false;
  const auto either = [&](const auto& leads) { return leads(prev_[i]) || leads(next_[i]); };
  const glm::dvec2& p = flat_[i];
  if (p == flat_[a]) return either([&](size_t to) { return leads_inside(a, b, c, to); });
  if (p == flat_[b]) return either([&](size_t to) { return leads_inside(b, c, a, to); });
  if (p == flat_[c]) return either([&](size_t to) { return leads_inside(c, a, b, to); });
  if (ab == 0) return either([&](size_t to) { return turn(a, b, to) > 0; });
  if (bc == 0) return either([&](size_t to) { return turn(b, c, to) > 0; });
  return true;
}

bool Triangulator::is_ear(uint32_t ear, uint64_t& work) const {
  const uint32_t a = prev_[ear], c = next_[ear];
  if (!(turn(a, ear, c) > 0)) return false;
  for (uint32_t i = next_[c]; i != a; i = next_[i]) {
    if (work == 0) return false;
    --work;
    if (forbids(i, a, ear, c)) return false;
  }
  return true;
}

void Triangulator::make_ring() {
  const uint32_t n = uint32_t(corners_.size());
  prev_.resize(n);
  next_.resize(n);
  for (uint32_t i = 0; i < n; ++i) {
    prev_[i] = i == 0 ? n - 1 : i - 1;
    next_[i] = i + 1 == n ? 0 : i + 1;
  }
  left_ = n;
}

// Takes a corner out of the ring, as the triangle with its neighbours; returns the one before it.
uint32_t Triangulator::clip(uint32_t corner, BatchWriter& writer) {
  const uint32_t a = prev_[corner], c = next_[corner];
  writer.add(corners_[a], corners_[corner], corners_[c]);
  next_[a] = c;
  prev_[c] = a;
  --left_;
  return a;
}

// Where `corner` is the tip of a slit (the ring comes to it and leaves it on the same way), takes
// the slit out, a triangle without area for each of its corners. Returns what is left at its foot,
// else `corner`. An ear must not be cut beside a slit: on a zero width nothing tells inside from
// outside.
uint32_t Triangulator::clip_slit(uint32_t corner, BatchWriter& writer) {
  while (left_ > 3 && flat_[prev_[corner]] == flat_[next_[corner]]) {
    corner = clip(corner, writer);
    if (left_ > 3) clip(next_[corner], writer);  // the same point once more
  }
  return corner;
}

void Triangulator::clip_ears(BatchWriter& writer) {
  make_ring();
  uint64_t work = kWorkPerCorner * left_;
  uint32_t here = 0;
  for (uint32_t i = left_; i > 0; --i) here = next_[clip_slit(here, writer)];
  // Without an ear all around, a corner that repeats the one before it goes; without that, the end.
  uint64_t tried = 0;
  while (left_ > 3 && tried < 2 * uint64_t(left_) && work > 0) {
    if (tried < left_ ? is_ear(here, work) : flat_[here] == flat_[prev_[here]]) {
      const uint32_t a = clip_slit(clip(here, writer), writer);
      const uint32_t c = clip_slit(next_[a], writer);
      here = next_[c];  // not c: the ears of a round shape would all share one corner
      tried = 0;
    } else {
      here = next_[here];
      ++tried;
    }
  }
  for (uint32_t i = next_[here]; next_[i] != here; i = next_[i])
    writer.add(corners_[here], corners_[i], corners_[next_[i]]);
}

}  // namespace svdag
