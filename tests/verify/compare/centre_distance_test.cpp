// Tests of the exact comparison of a centre's distance: correct to the last lattice step.
#include "verify/compare/centre_distance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace svdag {
namespace {

constexpr int kFraction = 23;
constexpr int64_t kCubeSide = int64_t(1) << kFraction, kHalf = kCubeSide / 2;
const LatticePoint kVoxel(7, 8, 9);
const LatticePoint kCentre = kVoxel * kCubeSide + kHalf;

// A triangle by its offsets from the centre, in lattice steps.
LatticeTriangle around(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c) {
  return {{kCentre + a, kCentre + b, kCentre + c}};
}

bool within(const LatticeTriangle& t, int quarters) {
  return centre_within(t, kVoxel, kFraction, quarters);
}

TEST(CentreDistance, AFaceOfTheCubeIsHalfAVoxelAway) {
  const int64_t far = 100 * kCubeSide;
  const auto plane = [&](int64_t z) {
    return around({-far, -far, z}, {far, -far, z}, {0, far, z});
  };
  EXPECT_TRUE(within(plane(kHalf), 1));
  EXPECT_FALSE(within(plane(kHalf + 1), 1));
  EXPECT_TRUE(within(plane(-kHalf), 1));
  EXPECT_FALSE(within(plane(-kHalf - 1), 1));
}

TEST(CentreDistance, ACornerOfTheCubeIsOnTheOuterBall) {
  const LatticePoint corner(kHalf, -kHalf, kHalf), beyond = corner * int64_t(3);
  EXPECT_TRUE(within(around(corner, beyond, beyond), 3));
  EXPECT_TRUE(within(around(corner, corner, corner), 3));
  EXPECT_FALSE(within(around(corner + LatticePoint(1, 0, 0), beyond, beyond), 3));
}

TEST(CentreDistance, ALongEdgeIsMeasuredAtItsMiddle) {
  const int64_t far = 1000 * kCubeSide;
  const LatticePoint up(0, 0, far), down(0, 0, -far), out(far, far, 0);
  EXPECT_TRUE(
      within(around(up + LatticePoint(kHalf, 0, 0), down + LatticePoint(kHalf, 0, 0), out), 1));
  EXPECT_FALSE(within(
      around(up + LatticePoint(kHalf + 1, 0, 0), down + LatticePoint(kHalf + 1, 0, 0), out), 1));
}

// Compares with sampled distances in long double, except where they are too close to the bound.
TEST(CentreDistance, AgreesWithDistancesInLongDouble) {
  using Vector = std::array<long double, 3>;
  std::mt19937_64 random(1);
  const auto dot = [](const Vector& a, const Vector& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  };
  int near = 0;
  for (int i = 0; i < 3000; ++i) {
    const int64_t reach = kCubeSide << random() % 4;
    LatticeTriangle t;
    for (LatticePoint& p : t.v)
      for (int a = 0; a < 3; ++a)
        p[a] = kCentre[a] + int64_t(random() % uint64_t(2 * reach)) - reach;
    if (i % 7 == 0) t.v[2] = t.v[1];
    if (i % 11 == 0) t.v[2] = t.v[1] = t.v[0];
    long double smallest = INFINITY;  // squared, by sampling: a close upper bound
    constexpr int kSteps = 160;
    for (int u = 0; u <= kSteps; ++u)
      for (int v = 0; u + v <= kSteps; ++v) {
        Vector p;
        for (int a = 0; a < 3; ++a)
          p[size_t(a)] = ((long double)(t.v[0][a] - kCentre[a]) * (kSteps - u - v) +
                          (long double)(t.v[1][a] - kCentre[a]) * u +
                          (long double)(t.v[2][a] - kCentre[a]) * v) /
                         kSteps / kCubeSide;
        smallest = std::min(smallest, dot(p, p));
      }
    const long double slack = 0.1L * (long double)(reach / kCubeSide);
    for (const int quarters : {1, 3}) {
      if (std::sqrt(smallest) <= std::sqrt(0.25L * quarters)) {
        EXPECT_TRUE(within(t, quarters));
        ++near;
      } else if (std::sqrt(smallest) > std::sqrt(0.25L * quarters) + slack) {
        EXPECT_FALSE(within(t, quarters));
      }
    }
  }
  EXPECT_GT(near, 300);
}

}  // namespace
}  // namespace svdag
