#include "io/scene/polygons/triangulate.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Sum over the edges, relative to the first corner so that large offsets cost no digits.
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

// The half plane of a direction: 1 for angles in [0, pi), 0 for [pi, 2 pi).
int half(const glm::dvec2& d) {
  return d.y > 0 || (d.y == 0 && d.x > 0) ? 1 : 0;
}

}  // namespace

void Triangulator::grow() {
  const size_t capacity = std::max<size_t>(64, 2 * corners_.capacity());
  if (capacity > UINT32_MAX / 2) fail_input(path_, "a polygon has too many corners");
  // The corners, half of them twice while they are moved, their projection, the ring, and the
  // search structures.
  const size_t bytes = sizeof(Point) * 3 / 2 + sizeof(glm::dvec2) + 2 * sizeof(uint32_t) +
                       CornerTree::kBytesPerCorner + EarCandidates::kBytesPerCorner;
  reservation_.resize(capacity * bytes, kPurpose);
  corners_.reserve(capacity);
}

void Triangulator::grow_texture() {
  // Half of them twice while they are moved.
  texture_reservation_.resize(corners_.capacity() * sizeof(TexturePoint) * 3 / 2, kPurpose);
  texture_.reserve(corners_.capacity());
}

void Triangulator::finish(BatchWriter& writer) {
  if (corners_.size() > 3 && project() && !is_convex()) {
    clip_ears(writer);
  } else {
    fan(writer);
  }
  corners_.clear();
  texture_.clear();
  colours_.clear();
}

void Triangulator::emit(size_t a, size_t b, size_t c, BatchWriter& writer) const {
  if (texture_.empty() && colours_.empty())
    return writer.add(corners_[a], corners_[b], corners_[c]);
  const Triangle triangle{{corners_[a], corners_[b], corners_[c]}};
  TextureCorners texture{};
  if (!texture_.empty()) texture = {texture_[a], texture_[b], texture_[c]};
  if (colours_.empty()) return writer.add_textured(triangle, texture);
  writer.add_textured(triangle, texture, {colours_[a], colours_[b], colours_[c]});
}

void Triangulator::fan(BatchWriter& writer) const {
  for (size_t i = 2; i < corners_.size(); ++i) emit(0, i - 1, i, writer);
}

// Fills flat_; false if the polygon has almost no area (or is not finite).
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

// The largest that turn(a, b, a corner in the box) can be, rounding included: turn() is monotone in
// both coordinates of its last corner, and so is each of its roundings.
double Triangulator::most_left(size_t a, size_t b, const FlatBox& box) const {
  const glm::dvec2 ab = flat_[b] - flat_[a];
  const glm::dvec2 p(ab.y > 0 ? box.min.x : box.max.x, ab.x > 0 ? box.max.y : box.min.y);
  const glm::dvec2 ac = p - flat_[a];
  return ab.x * ac.y - ab.y * ac.x;
}

// The box of all corners that forbids() can find in the triangle. turn() errs by less than `error`,
// so none of a corner's barycentric coordinates in a, b, c (its turns over the area) is less than
// -error / area, and it is outside of their box by at most twice that fraction of the box's width.
FlatBox Triangulator::reach(size_t a, size_t b, size_t c) const {
  const glm::dvec2 all = tree_.box().max - tree_.box().min;
  const double span = std::max(all.x, all.y), error = 0x1p-49 * span * span;
  const double area = turn(a, b, c) - error;
  const double part = area > 0 ? 4 * error / area : INFINITY;
  const FlatBox box = {glm::min(glm::min(flat_[a], flat_[b]), flat_[c]),
                       glm::max(glm::max(flat_[a], flat_[b]), flat_[c])};
  const glm::dvec2 slack = part * (box.max - box.min);
  return {box.min - slack, box.max + slack};
}

// No right turn, and once around only: a pentagram turns left everywhere, but goes around twice.
// A corner that repeats the one before it is skipped: it would hide a right turn there.
bool Triangulator::is_convex() const {
  size_t b = flat_.size() - 1, a = b;  // the edge from a to b, and the next corner c
  while (a > 0 && flat_[a] == flat_[b]) --a;
  int changes = 0, last = half(flat_[b] - flat_[a]);
  for (size_t c = 0; c < flat_.size(); ++c) {
    if (flat_[c] == flat_[b]) continue;
    if (!(turn(a, b, c) >= 0)) return false;
    const int side = half(flat_[c] - flat_[b]);
    if (side != last) ++changes;
    last = side;
    a = b;
    b = c;
  }
  return changes == 2;
}

// Whether the edge from corner `from` to corner `to` of the ring leads into the triangle at once;
// left and right: the other two corners of the triangle, as seen from `from`.
bool Triangulator::leads_inside(size_t from, size_t right, size_t left, size_t to) const {
  return turn(from, right, to) > 0 && turn(from, to, left) > 0;
}

// Whether corner i of the ring forbids the ear a, b, c: it is in the closed triangle, and if it
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

// Whether a candidate is an ear; if not, it stops being a candidate.
bool Triangulator::is_ear(uint32_t ear) {
  const uint32_t a = prev_[ear], c = next_[ear];
  if (!(turn(a, ear, c) > 0)) {
    candidates_.erase(ear);
    return false;
  }
  const FlatBox near = reach(a, ear, c);
  const auto may_hold = [&](const FlatBox& box) {
    count_step();
    if (box.max.x < near.min.x || box.min.x > near.max.x) return false;
    if (box.max.y < near.min.y || box.min.y > near.max.y) return false;
    return !(most_left(a, ear, box) < 0 || most_left(ear, c, box) < 0 || most_left(c, a, box) < 0);
  };
  const uint32_t other = tree_.find(may_hold, [&](uint32_t i) {
    count_step();
    return i != a && i != ear && i != c && forbids(i, a, ear, c);
  });
  if (other == CornerTree::kNone) return true;
  candidates_.wait(ear, other);
  return false;
}

// The first ear of the ring from `from` on, or CornerTree::kNone.
uint32_t Triangulator::next_ear(uint32_t from) {
  for (;;) {
    uint32_t i = candidates_.next(from);
    if (i == UINT32_MAX) i = candidates_.next(0);
    if (i == UINT32_MAX || is_ear(i)) return i;
    from = i;
  }
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
  done_ = 0;
  tree_.build(flat_);
  candidates_.reset(n);
}

void Triangulator::count_step() {
  if (++done_ > steps_ * corners_.size())
    fail_input(path_, "a polygon of " + format_count(corners_.size()) +
                          " corners is too entangled to be cut into triangles");
}

// The ring has changed at a corner: it may now be an ear, and corners that it blocked may be, too.
void Triangulator::ask_again(uint32_t corner) {
  candidates_.insert(corner);
  candidates_.wake(corner, [&](uint32_t ear) {
    count_step();
    return !forbids(corner, prev_[ear], ear, next_[ear]);
  });
}

// Removes a corner from the ring as the triangle with its neighbours; returns the previous corner.
uint32_t Triangulator::clip(uint32_t corner, BatchWriter& writer) {
  const uint32_t a = prev_[corner], c = next_[corner];
  emit(a, corner, c, writer);
  next_[a] = c;
  prev_[c] = a;
  --left_;
  tree_.remove(corner);
  candidates_.erase(corner);
  candidates_.wake(corner, [](uint32_t) { return true; });
  ask_again(a);
  ask_again(c);
  return a;
}

// Removes repeats of the previous corner: the ring does not turn there, so they are not ears.
void Triangulator::clip_repeats(BatchWriter& writer) {
  for (uint32_t i = 0; i < corners_.size() && left_ > 3; ++i) {
    if (flat_[i] == flat_[prev_[i]]) clip(i, writer);
  }
}

// Where `corner` is the tip of a slit (the ring comes to it and leaves it on the same way), takes
// the slit out, a triangle without area for each of its corners. Returns the remaining corner at
// its foot, else `corner`. An ear must not be cut beside a slit: inside and outside cannot be
// distinguished at zero width.
uint32_t Triangulator::clip_slit(uint32_t corner, BatchWriter& writer) {
  while (left_ > 3 && flat_[prev_[corner]] == flat_[next_[corner]]) {
    corner = clip(corner, writer);
    if (left_ > 3) clip(next_[corner], writer);  // the same point again
  }
  return corner;
}

void Triangulator::clip_ears(BatchWriter& writer) {
  make_ring();
  clip_repeats(writer);
  uint32_t here = candidates_.next(0);
  for (uint32_t i = left_; i > 0; --i) here = next_[clip_slit(here, writer)];
  while (left_ > 3) {
    const uint32_t ear = next_ear(here);
    if (ear == CornerTree::kNone) break;
    const uint32_t a = clip_slit(clip(ear, writer), writer);
    const uint32_t c = clip_slit(next_[a], writer);
    here = next_[c];  // not c: the ears of a round shape would all share one corner
  }
  for (uint32_t i = next_[here]; next_[i] != here; i = next_[i]) emit(here, i, next_[i], writer);
}

}  // namespace svdag
