// Polygons that touch themselves: holes joined by slits, slits that end inside and outside.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "tests/io/scene/polygons/triangulated.h"

namespace svdag {
namespace {

// All is small integers here, or halves of them: exact in double.
using Ring = std::vector<Point>;

double dot(const Point& corner, const Point& a, const Point& b) {
  return (a.x - corner.x) * (b.x - corner.x) + (a.y - corner.y) * (b.y - corner.y);
}

bool lies_inside_edge(const Point& p, const Point& a, const Point& b) {
  return area(a, b, p) == 0 && dot(p, a, b) < 0;
}

bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  return area(a, b, c) * area(a, b, d) < 0 && area(c, d, a) * area(c, d, b) < 0;
}

const Point& after(const Ring& ring, size_t i) {
  return ring[(i + 1) % ring.size()];
}

const Point& before(const Ring& ring, size_t i) {
  return ring[(i + ring.size() - 1) % ring.size()];
}

// Whether the segment between two corners (or new points) meets the ring anywhere else.
bool meets(const Ring& ring, const Point& a, const Point& b) {
  for (size_t i = 0; i < ring.size(); ++i) {
    const Point &c = ring[i], &d = after(ring, i);
    if (cross(a, b, c, d) || lies_inside_edge(c, a, b)) return true;
    if (lies_inside_edge(a, c, d) || lies_inside_edge(b, c, d)) return true;
  }
  return false;
}

// Whether the way from corner i to `to` begins on the left of the ring.
bool begins_left(const Ring& ring, size_t i, const Point& to) {
  const Point &p = ring[i], &next = after(ring, i), &prev = before(ring, i);
  const double wedge = area(p, next, prev);
  if (wedge > 0) return area(p, next, to) > 0 && area(p, to, prev) > 0;
  if (wedge < 0) return !(area(p, prev, to) >= 0 && area(p, to, next) >= 0);
  if (dot(p, next, prev) < 0) return area(p, next, to) > 0;
  return !(area(p, next, to) == 0 && dot(p, next, to) > 0);
}

// How often the ring winds around a point that is not on it.
int winding(const Ring& ring, const Point& p) {
  int turns = 0;
  for (size_t i = 0; i < ring.size(); ++i) {
    const Point &a = ring[i], &b = after(ring, i);
    if (a.y <= p.y && p.y < b.y && area(a, b, p) > 0) ++turns;
    if (b.y <= p.y && p.y < a.y && area(a, b, p) < 0) --turns;
  }
  return turns;
}

// Weakly simple polygons on a small grid, counter-clockwise.
class RandomPolygon {
 public:
  explicit RandomPolygon(std::mt19937* random) : random_(*random) {}

  Ring make() {
    const double side = below(3) + 4;
    ring_ = {{0, 0, 0}, {side, 0, 0}, {side, side, 0}, {0, side, 0}};
    for (int i = below(6); i > 0; --i) dent(&ring_, point());
    for (int i = below(200); i > 0; --i) {  // most do not fit
      if (below(10) == 0) {
        add_slit(point());
      } else {
        add_hole();
      }
    }
    std::rotate(ring_.begin(), ring_.begin() + below(int(ring_.size())), ring_.end());
    return ring_;
  }

 private:
  int below(int n) { return int(random_() % uint32_t(n)); }
  Point point() { return {double(below(8) - 1), double(below(8) - 1), 0}; }
  Point step() { return {double(below(5) - 2), double(below(5) - 2), 0}; }
  bool is_corner(const Point& p) const {
    return std::find(ring_.begin(), ring_.end(), p) != ring_.end();
  }

  // Leads an edge over `p`, where that keeps the ring simple.
  void dent(Ring* ring, const Point& p) {
    const size_t i = size_t(below(int(ring->size())));
    const Point a = (*ring)[i], b = after(*ring, i);
    if (std::find(ring->begin(), ring->end(), p) != ring->end() || lies_inside_edge(p, a, b))
      return;
    if (meets(*ring, a, p) || meets(*ring, p, b)) return;
    ring->insert(ring->begin() + ptrdiff_t(i) + 1, p);
    for (size_t k = 0; k < ring->size(); ++k) {  // the other corners stay on their side
      if ((*ring)[k] == a || (*ring)[k] == b || (*ring)[k] == p) continue;
      const double u = area(a, p, (*ring)[k]), v = area(p, b, (*ring)[k]),
                   w = area(b, a, (*ring)[k]);
      if ((u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0)) {
        ring->erase(ring->begin() + ptrdiff_t(i) + 1);
        return;
      }
    }
  }

  // Whether a slit may go from corner i to `to`. Where the ring comes by several times, only into
  // the polygon, and from that corner whose wedge no other one divides: any other slit would cross
  // the ring.
  bool may_leave(size_t i, const Point& to) const {
    const Point& p = ring_[i];
    if (std::count(ring_.begin(), ring_.end(), p) == 1) return true;
    if (winding(ring_, (p + to) / 2.0) != 1 || !begins_left(ring_, i, to)) return false;
    for (size_t k = 0; k < ring_.size(); ++k) {
      if (k == i || ring_[k] != p) continue;
      if (begins_left(ring_, i, after(ring_, k)) || begins_left(ring_, i, before(ring_, k)))
        return false;
    }
    return true;
  }

  // From a corner to a point inside or outside, and back.
  void add_slit(const Point& p) {
    const size_t i = size_t(below(int(ring_.size())));
    const Point a = ring_[i];
    if (is_corner(p) || meets(ring_, a, p) || !may_leave(i, p)) return;
    ring_.insert(ring_.begin() + ptrdiff_t(i) + 1, {p, a});
  }

  // A triangle, with dents, joined by a slit from a corner to a corner.
  void add_hole() {
    const Point first = point();
    Ring hole = {first, first + step(), first + step()};
    if (area(hole[0], hole[1], hole[2]) >= 0) return;  // holes are clockwise
    for (int i = below(3); i > 0; --i) dent(&hole, point());
    for (size_t k = 0; k < hole.size(); ++k) {
      if (is_corner(hole[k]) || meets(ring_, hole[k], after(hole, k))) return;
      if (winding(ring_, hole[k]) != 1) return;
    }
    for (const Point& p : ring_) {
      if (winding(hole, p) != 0) return;
    }
    const size_t i = size_t(below(int(ring_.size()))), k = size_t(below(int(hole.size())));
    if (meets(ring_, ring_[i], hole[k]) || meets(hole, ring_[i], hole[k])) return;
    if (!may_leave(i, hole[k])) return;
    std::rotate(hole.begin(), hole.begin() + ptrdiff_t(k), hole.end());
    hole.push_back(hole.front());
    hole.push_back(ring_[i]);
    ring_.insert(ring_.begin() + ptrdiff_t(i) + 1, hole.begin(), hole.end());
  }

  std::mt19937& random_;
  Ring ring_;
};

// Every point between the lines of the grid is in one triangle if the polygon holds it, else in
// none; those on an edge of a triangle are not asked.
void expect_same_points(const Ring& ring) {
  const auto triangles = triangulate(ring);
  for (int x = -2; x < 16; ++x) {
    for (int y = -2; y < 16; ++y) {
      const Point p(x * 0.5 + 0.125, y * 0.5 + 0.0625, 0);
      int in = 0;
      bool on_edge = false;
      for (const Triangle& t : triangles) {
        const double u = area(t.v[0], t.v[1], p), v = area(t.v[1], t.v[2], p),
                     w = area(t.v[2], t.v[0], p);
        on_edge = on_edge || u == 0 || v == 0 || w == 0;
        in += (u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0);
      }
      if (on_edge) continue;
      EXPECT_EQ(in, std::abs(winding(ring, p))) << p.x << " " << p.y;
    }
  }
}

size_t count_repeated(Ring ring) {
  const auto before = [](const Point& a, const Point& b) {
    return a.x != b.x ? a.x < b.x : a.y < b.y;
  };
  std::sort(ring.begin(), ring.end(), before);
  return size_t(ring.end() - std::unique(ring.begin(), ring.end()));
}

std::string text(const Ring& ring) {
  std::string out;
  for (const Point& p : ring)
    out += "(" + std::to_string(int(p.x)) + "," + std::to_string(int(p.y)) + ")";
  return out;
}

TEST(WeaklySimple, AHoleWhoseSlitRunsAlongEdgesStaysOpen) {
  Ring ring = {{2, 2, 0}, {3, 2, 0}, {3, 1, 0}, {1, 1, 0}, {1, 0, 0},
               {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 1, 0}, {2, 1, 0}};
  for (size_t turns = 0; turns < ring.size(); ++turns) {
    expect_partition(ring);
    expect_same_points(ring);
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
  }
}

TEST(WeaklySimple, SlitsOfAnyShapeAddNothing) {
  // Out of a triangle, with two arms; into a square, with two arms; an arm at both ends of an edge.
  for (const Ring& ring :
       {Ring{{3, 0, 0},
             {0, 1, 0},
             {-3, 2, 0},
             {-3, 0, 0},
             {-3, 2, 0},
             {-5, 3, 0},
             {-3, 2, 0},
             {0, 1, 0},
             {3, 3, 0}},
        Ring{{0, 0, 0},
             {8, 0, 0},
             {8, 8, 0},
             {0, 8, 0},
             {0, 0, 0},
             {3, 4, 0},
             {6, 3, 0},
             {3, 4, 0},
             {4, 7, 0},
             {3, 4, 0}},
        Ring{{0, 0, 0}, {1, -2, 0}, {0, 0, 0}, {4, 0, 0}, {5, 5, 0}, {4, 0, 0}, {2, 3, 0}}}) {
    expect_partition(ring);
    expect_same_points(ring);
  }
}

TEST(WeaklySimple, RepeatedCornersOfAConcavePolygonChangeNothing) {
  Ring ring = {{0, 0, 0}, {4, -3, 0}, {4, -3, 0}, {1, 0, 0}, {4, 3, 0}, {4, 3, 0}};
  for (size_t turns = 0; turns < ring.size(); ++turns) {
    expect_partition(ring);
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
  }
}

TEST(WeaklySimple, ARepeatHidesNoReflexCorner) {
  Ring ring = {{4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 2, 0}, {1, 2, 0}, {1, 2, 0}};
  for (size_t turns = 0; turns < ring.size(); ++turns) {
    expect_partition(ring);
    expect_same_points(ring);
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
  }
}

TEST(WeaklySimple, RepeatsChangeNothingOfRandomPolygons) {
  std::mt19937 random(2);
  for (int i = 0; i < 10000; ++i) {
    Ring ring = RandomPolygon(&random).make();
    for (auto repeats = random() % 6 + 1; repeats > 0; --repeats) {
      const size_t k = random() % ring.size();
      ring.insert(ring.begin() + ptrdiff_t(k), ring[k]);
    }
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
    expect_partition(ring);
    expect_same_points(ring);
    ASSERT_FALSE(HasFailure()) << text(ring);
  }
}

TEST(WeaklySimple, RandomPolygonsWithHolesAndSlitsAreCoveredExactly) {
  std::mt19937 random(1);
  size_t repeated = 0;
  for (int i = 0; i < 20000; ++i) {
    Ring ring = RandomPolygon(&random).make();
    if (i % 2 == 1) std::reverse(ring.begin(), ring.end());
    repeated += count_repeated(ring);
    expect_partition(ring);
    expect_same_points(ring);
    ASSERT_FALSE(HasFailure()) << text(ring);
  }
  EXPECT_GT(repeated, 10000U);
}

}  // namespace
}  // namespace svdag
