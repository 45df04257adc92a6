// Ear clipping as io/scene/polygons/triangulate.h defines it, without what makes it fast: each
// corner is tested against all others, and all are tested again after each ear. In the plane z = 0.
#pragma once

#include <optional>
#include <vector>

#include "io/triangle.h"

namespace svdag {

class PlainTriangulation {
 public:
  // Nothing for polygons that go around the other way or have no right turn: those may be fans.
  static std::optional<std::vector<Triangle>> of(const std::vector<Point>& polygon) {
    PlainTriangulation plain(polygon);
    plain.drop_repeats();
    double whole = 0;
    bool right_turn = false;
    for (size_t i = 0; i < plain.ring_.size(); ++i) {
      whole += plain.turn(polygon[0], plain.at(i), plain.at(i + 1));
      right_turn = right_turn || plain.turn(plain.at(i), plain.at(i + 1), plain.at(i + 2)) < 0;
    }
    if (!(whole > 0) || !right_turn) return {};
    plain.clip();
    return plain.triangles_;
  }

 private:
  explicit PlainTriangulation(const std::vector<Point>& polygon) : ring_(polygon) {}

  static double turn(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  }
  static bool same(const Point& a, const Point& b) { return a.x == b.x && a.y == b.y; }
  const Point& at(size_t i) const { return ring_[i % ring_.size()]; }
  size_t before(size_t i) const { return (i + ring_.size() - 1) % ring_.size(); }
  size_t after(size_t i) const { return (i + 1) % ring_.size(); }

  // Places in the ring move down with what is taken out before them.
  void take(size_t i, size_t* here) {
    triangles_.push_back({{at(before(i)), at(i), at(i + 1)}});
    ring_.erase(ring_.begin() + ptrdiff_t(i));
    if (*here > i) --*here;
    *here %= ring_.size();
  }
  void drop_repeats() {
    size_t unused = 0;
    for (size_t left = ring_.size(), i = 0; left > 0 && ring_.size() > 3; --left) {
      if (same(at(i), at(before(i))))
        take(i, &unused);
      else
        ++i;
    }
  }
  // Returns the place of the foot of the slit whose tip is i, or i.
  size_t take_slit(size_t i) {
    while (ring_.size() > 3 && same(at(before(i)), at(i + 1))) {
      size_t foot = before(i);
      take(i, &foot);
      if (ring_.size() > 3) take(after(foot), &foot);
      i = foot;
    }
    return i;
  }

  bool forbids(size_t i, const Point& a, const Point& b, const Point& c) const {
    const Point &p = at(i), &prev = at(before(i)), &next = at(after(i));
    if (turn(a, b, p) < 0 || turn(b, c, p) < 0 || turn(c, a, p) < 0) return false;
    const auto enters = [&](const Point& from, const Point& right, const Point& left) {
      const auto leads = [&](const Point& to) {
        return turn(from, right, to) > 0 && turn(from, to, left) > 0;
      };
      return leads(prev) || leads(next);
    };
    if (same(p, a)) return enters(a, b, c);
    if (same(p, b)) return enters(b, c, a);
    if (same(p, c)) return enters(c, a, b);
    if (turn(a, b, p) == 0) return turn(a, b, prev) > 0 || turn(a, b, next) > 0;
    if (turn(b, c, p) == 0) return turn(b, c, prev) > 0 || turn(b, c, next) > 0;
    return true;
  }
  bool is_ear(size_t i) const {
    const Point &a = at(before(i)), &b = at(i), &c = at(after(i));
    if (!(turn(a, b, c) > 0)) return false;
    for (size_t k = 2; k + 1 < ring_.size(); ++k) {
      if (forbids((i + k) % ring_.size(), a, b, c)) return false;
    }
    return true;
  }

  void clip() {
    size_t here = 0;
    for (size_t i = ring_.size(); i > 0; --i) here = after(take_slit(here));
    for (size_t tried = 0; ring_.size() > 3 && tried < ring_.size();) {
      if (!is_ear(here)) {
        here = after(here);
        ++tried;
        continue;
      }
      size_t a = before(here);
      take(here, &a);
      here = after(take_slit(after(take_slit(a))));
      tried = 0;
    }
    for (size_t k = 1; k + 1 < ring_.size(); ++k)
      triangles_.push_back({{at(here), at(here + k), at(here + k + 1)}});
  }

  std::vector<Point> ring_;
  std::vector<Triangle> triangles_;
};

}  // namespace svdag
