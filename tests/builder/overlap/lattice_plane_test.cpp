#include "builder/overlap/lattice_plane.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace svdag {
namespace {

LatticePoint draw_lattice_point(std::mt19937_64& random, int64_t reach) {
  LatticePoint p;
  for (int a = 0; a < 3; ++a) p[a] = int64_t(random() % uint64_t(2 * reach + 1)) - reach;
  return p;
}

__int128 dot(const int64_t n[3], const LatticePoint& p) {
  return __int128(n[0]) * p.x + __int128(n[1]) * p.y + __int128(n[2]) * p.z;
}

TEST(LatticePlane, OfSmallWholeNormalsIsExactAndPrimitive) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 5000; ++i) {
    // Two directions in the plane of a small normal n.
    const int64_t reach = int64_t(1) << (1 + random() % 25);
    const LatticePoint n = draw_lattice_point(random, reach);
    if (n.x == 0 || n.y == 0) continue;
    const LatticePoint a(n.y, -n.x, 0), b(n.z, 0, -n.x);
    const LatticePoint v = draw_lattice_point(random, int64_t(1) << 30);
    const TriangleSetup t = make_setup({{v, v + a * int64_t(5), v + b * int64_t(7)}});
    const auto plane = lattice_plane(t);
    ASSERT_TRUE(plane.has_value());
    ASSERT_TRUE(plane->exact) << n.x << ' ' << n.y << ' ' << n.z;
    const int64_t divisor = std::gcd(std::gcd(n.x, n.y), n.z), sign = n.x < 0 ? -1 : 1;
    for (int k = 0; k < 3; ++k) EXPECT_EQ(plane->n[k], sign * n[k] / divisor);
  }
}

TEST(LatticePlane, OffsetsOfAColumnHoldTheTriangleInIt) {
  std::mt19937_64 random(2);
  int rounded = 0;
  for (int i = 0; i < 20000; ++i) {
    const int64_t reach = int64_t(1) << (24 + random() % 15);
    const LatticePoint at = draw_lattice_point(random, reach);
    const TriangleSetup t =
        make_setup({{at + draw_lattice_point(random, reach), at + draw_lattice_point(random, reach),
                     at + draw_lattice_point(random, reach)}});
    const auto plane = lattice_plane(t);
    if (!plane) continue;
    rounded += !plane->exact;
    // Points of the triangle, and a column that holds each.
    const int64_t x = int64_t(random() % 1025), y = int64_t(random() % uint64_t(1025 - x));
    const auto& v = t.triangle.v;
    const LatticePoint scaled = v[0] * (1024 - x - y) + v[1] * x + v[2] * y;  // 1024 times a point
    const int64_t side = int64_t(1) << (20 + random() % 10);
    LatticePoint corner;
    for (int a = 0; a < 3; ++a)
      corner[a] = (scaled[a] >> 10) - int64_t(random() % uint64_t(side - 1));
    for (const auto& range :
         {offsets_in_column(*plane, corner, side), offsets_along(*plane, t, corner, side)}) {
      if (!range) continue;
      const __int128 g = dot(plane->n, scaled) - 1024 * dot(plane->n, corner);
      EXPECT_LE(__int128(range->low) * 1024, g);
      EXPECT_GE(__int128(range->high) * 1024, g);
      if (!plane->exact) {
        EXPECT_LT(__int128(range->low) * 1024, g);
        EXPECT_GT(__int128(range->high) * 1024, g);
      }
    }
  }
  EXPECT_GT(rounded, 10000);
}

TEST(LatticePlane, OfDegenerateAndWideTrianglesIsNone) {
  const LatticePoint p(1, 2, 3), far(int64_t(1) << 42, 0, 0);
  EXPECT_FALSE(lattice_plane(make_setup({{p, p, p}})));
  EXPECT_FALSE(lattice_plane(make_setup({{p, p + p, p + p + p}})));
  EXPECT_FALSE(lattice_plane(make_setup({{p, far, LatticePoint(0, 100, 0)}})));
}

}  // namespace
}  // namespace svdag
