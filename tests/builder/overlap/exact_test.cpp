#include "builder/overlap/exact.h"

#include <gtest/gtest.h>

#include <random>

namespace svdag {
namespace {

LatticePoint draw_point(std::mt19937_64& random, int64_t limit) {
  LatticePoint p;
  for (int a = 0; a < 3; ++a) p[a] = int64_t(random() % uint64_t(2 * limit - 1)) - (limit - 1);
  return p;
}

TEST(Exact, NarrowAndWideAgreeUpToTheNarrowLimit) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 2000; ++i) {
    const int64_t limit = int64_t(1) << (2 + random() % 40);
    TriangleSetup t = make_setup(
        {{draw_point(random, limit), draw_point(random, limit), draw_point(random, limit)}});
    EXPECT_FALSE(t.wide);
    const LatticePoint x = i % 3 ? draw_point(random, limit) : t.triangle.v[size_t(i) % 3];
    const int plane = exact_plane_sign(t, x);
    EXPECT_EQ(plane, wide::plane_sign(t, x));
    for (int k = 0; k < 9; ++k) {
      if (!(t.edges >> k & 1)) continue;
      const int narrow = exact_edge_sign(t, k, x);
      t.wide = true;
      EXPECT_EQ(narrow, exact_edge_sign(t, k, x));
      t.wide = false;
    }
  }
}

TEST(Exact, TheBitBudgetHoldsAtTheCornersOfTheRange) {
  // Vertices at the corners of the narrow range and x at the corners of the grid make every term as
  // large as it can be.
  constexpr int64_t kMax = kNarrowLimit - 1, kGrid = int64_t(1) << 39;
  std::mt19937_64 random(2);
  const auto corner = [&](int64_t low, int64_t high) {
    return LatticePoint(random() & 1 ? low : high, random() & 1 ? low : high,
                        random() & 1 ? low : high);
  };
  for (int i = 0; i < 5000; ++i) {
    const TriangleSetup t =
        make_setup({{corner(-kMax, kMax), corner(-kMax, kMax), corner(-kMax, kMax)}});
    const LatticePoint x = corner(0, kGrid);
    EXPECT_EQ(exact_plane_sign(t, x), wide::plane_sign(t, x));
  }
}

TEST(Exact, OneStepOffAPlaneIsDecided) {
  const int64_t s = (int64_t(1) << 40) + 12345;
  const TriangleSetup t =
      make_setup({{LatticePoint(s, 0, 0), LatticePoint(0, s, 0), LatticePoint(0, 0, s)}});
  const LatticePoint on(s / 3, s / 3, s - 2 * (s / 3));
  EXPECT_EQ(exact_plane_sign(t, on), 0);
  EXPECT_EQ(exact_plane_sign(t, on + LatticePoint(1, 0, 0)), 1);
  EXPECT_EQ(exact_plane_sign(t, on - LatticePoint(0, 0, 1)), -1);
}

TEST(TriangleSetup, HandlesSegmentsAndPoints) {
  const LatticePoint a(1, 2, 3), b(10, 20, 30), middle(4, 8, 12);
  EXPECT_EQ(make_setup({{a, a, a}}).edges, 0);
  EXPECT_EQ(make_setup({{a, b, a}}).edges, 0b011011011);
  const TriangleSetup collinear =
      make_setup({{LatticePoint(4, 8, 12), LatticePoint(1, 2, 3), LatticePoint(10, 20, 30)}});
  EXPECT_EQ(collinear.edges, 0b011011011);
  EXPECT_EQ(collinear.triangle.v[collinear.from[0]], a);
  EXPECT_EQ(collinear.triangle.v[collinear.to[0]], b);
  EXPECT_EQ(make_setup({{a, b, middle + LatticePoint(0, 0, 1)}}).edges, 0b111111111 & ~0b111000000);
}

}  // namespace
}  // namespace svdag
