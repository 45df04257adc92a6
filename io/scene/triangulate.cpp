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

// Whether the closed triangle a, b, c holds a point that is none of its corners.
bool Triangulator::holds(size_t a, size_t b, size_t c, size_t point) const {
  const glm::dvec2& p = flat_[point];
  if (p == flat_[a] || p == flat_[b] || p == flat_[c]) return false;
  return turn(a, b, point) >= 0 && turn(b, c, point) >= 0 && turn(c, a, point) >= 0;
}

bool Triangulator::is_ear(uint32_t ear, uint64_t& work) const {
  const uint32_t a = prev_[ear], c = next_[ear];
  if (!(turn(a, ear, c) > 0)) return false;
  for (uint32_t i = next_[c]; i != a; i = next_[i]) {
    if (work == 0) return false;
    --work;
    if (holds(a, ear, c, i)) return false;
  }
  return true;
}

void Triangulator::clip_ears(BatchWriter& writer) {
  const uint32_t n = uint32_t(corners_.size());
  prev_.resize(n);
  next_.resize(n);
  for (uint32_t i = 0; i < n; ++i) {
    prev_[i] = i == 0 ? n - 1 : i - 1;
    next_[i] = i + 1 == n ? 0 : i + 1;
  }
  uint64_t work = kWorkPerCorner * n;
  uint32_t here = 0, left = n, tried = 0;
  while (left > 3 && tried < left && work > 0) {
    if (is_ear(here, work)) {
      const uint32_t a = prev_[here], c = next_[here];
      writer.add(corners_[a], corners_[here], corners_[c]);
      next_[a] = c;
      prev_[c] = a;
      here = next_[c];  // not c: the ears of a round shape would all share one corner
      --left;
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
