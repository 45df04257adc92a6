// Closed forms for the number of voxels that simple bodies set, at any size and position.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/stress/family.h"

namespace svdag {
namespace {

constexpr int kGrids[4] = {10, 13, 16, 20};

uint64_t count_voxels(const Spot& spot, Rule rule, const Soup& soup) {
  uint64_t voxels = 0;
  const uint64_t total =
      voxelize_window(spot.grid, {.rule = rule}, spot.start, soup,
                      [&](const LatticePoint&, Brick b) { voxels += uint64_t(std::popcount(b)); });
  EXPECT_EQ(total, voxels);
  return voxels;
}

// Calls check(spot, random, at) for many positions `at`: voxel corners that are at least 160 voxels
// inside the grid, near zero, anywhere, and near the far corner.
template <class Check>
void everywhere(const Check& check) {
  StressRandom random(11);
  for (const int levels : kGrids) {
    Spot spot;
    spot.grid = unit_grid(levels);
    const int64_t low = 160, high = spot.grid.resolution() - 160;
    for (int round = 0; round < 12; ++round) {
      LatticePoint at{random.between(low, high), random.between(low, high),
                      random.between(low, high)};
      if (round == 0) at = LatticePoint(low);
      if (round == 1) at = LatticePoint(high);
      check(spot, &random, at * spot.voxel());
    }
  }
}

// The twelve triangles of a box.
Soup box(const LatticePoint& low, const LatticePoint& size) {
  Soup soup;
  for (int w = 0; w < 3; ++w) {
    LatticePoint u(0), v(0), up(0);
    u[(w + 1) % 3] = size[(w + 1) % 3];
    v[(w + 2) % 3] = size[(w + 2) % 3];
    up[w] = size[w];
    for (const LatticePoint& at : {low, low + up}) {
      soup.push_back({{at, at + u, at + u + v}});
      soup.push_back({{at, at + u + v, at + v}});
    }
  }
  return soup;
}

uint64_t product(const LatticePoint& p) {
  return uint64_t(p.x * p.y * p.z);
}

LatticePoint draw_size(StressRandom* random) {
  return {random->between(4, 70), random->between(4, 70), random->between(4, 70)};
}

// A point strictly inside the voxel above a corner.
LatticePoint inside_voxel(const Spot& spot, StressRandom* random) {
  const int64_t last = spot.voxel() - 1;
  return {random->between(1, last), random->between(1, last), random->between(1, last)};
}

TEST(ClosedForm, ABoxOnVoxelPlanesHasWallsOfTwoVoxels) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const LatticePoint s = draw_size(random), two(2);
    EXPECT_EQ(count_voxels(spot, Rule::kConservative, box(at, s * spot.voxel())),
              product(s + two) - product(s - two));
  });
}

TEST(ClosedForm, ABoxOffVoxelPlanesHasWallsOfOneVoxel) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const LatticePoint s = draw_size(random), one(1);
    const LatticePoint off = inside_voxel(spot, random);
    EXPECT_EQ(count_voxels(spot, Rule::kConservative, box(at + off, s * spot.voxel())),
              product(s + one) - product(s - one));
  });
}

TEST(ClosedForm, TheTriangleAcrossTheAxes) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const int64_t c = random->between(1, 70), s = c * spot.voxel();
    const LatticeTriangle t{
        {at + LatticePoint(s, 0, 0), at + LatticePoint(0, s, 0), at + LatticePoint(0, 0, s)}};
    EXPECT_EQ(count_voxels(spot, Rule::kConservative, {t}), uint64_t(2 * c * c + 9 * c + 8)) << c;
  });
}

TEST(ClosedForm, ADiagonalOfCollinearVertices) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const int64_t n = random->between(1, 140);
    const LatticePoint end = at + LatticePoint(n * spot.voxel());
    const LatticePoint middle = at + LatticePoint(random->between(0, n * spot.voxel()));
    EXPECT_EQ(count_voxels(spot, Rule::kConservative, {{{at, end, middle}}}), uint64_t(7 * n + 8));
    EXPECT_EQ(count_voxels(spot, Rule::kConservative, {{{end, end, at}}}), uint64_t(7 * n + 8));
    EXPECT_EQ(count_voxels(spot, Rule::kThin, {{{at, end, middle}}}), 0U);
  });
}

TEST(ClosedForm, APointTouchesEightFourTwoOrOneVoxels) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const LatticePoint off = inside_voxel(spot, random);
    for (unsigned inside = 0; inside < 8; ++inside) {  // bit a: off the planes of axis a
      LatticePoint p = at;
      for (int a = 0; a < 3; ++a) p[a] += (inside >> a & 1) != 0 ? off[a] : 0;
      EXPECT_EQ(count_voxels(spot, Rule::kConservative, {{{p, p, p}}}),
                8U >> std::popcount(inside));
      EXPECT_EQ(count_voxels(spot, Rule::kThin, {{{p, p, p}}}), 0U);
    }
  });
}

// Under the thin rule a rectangle of whole voxels sets as many voxels as its area, on planes, on
// centres and anywhere else: every line of centres that meets it sets one, and ties go one way.
TEST(ClosedForm, AThinRectangleHasItsArea) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const LatticePoint s = draw_size(random);
    LatticePoint corner = at;
    if (random->coin()) corner += LatticePoint(spot.voxel() / 2);
    if (random->coin()) corner += inside_voxel(spot, random);
    const Soup soup = box(corner, s * spot.voxel());
    for (int w = 0; w < 3; ++w) {
      const Soup face(soup.begin() + 4 * w, soup.begin() + 4 * w + 2);
      EXPECT_EQ(count_voxels(spot, Rule::kThin, face), uint64_t(s[(w + 1) % 3] * s[(w + 2) % 3]));
    }
  });
}

TEST(ClosedForm, TheFractionFollowsFromTheResolutionAlone) {
  StressRandom random(12);
  for (int levels = kMinLevels; levels <= kMaxLevels; ++levels) {
    for (int round = 0; round < 50; ++round) {
      const double scale = std::ldexp(1.0, int(random.between(-100, 50)));
      Box scene;
      scene.add(scale * Point(random.unit(), random.unit(), random.unit()));
      scene.add(scale * Point(1 + random.unit(), 1 + random.unit(), 1 + random.unit()));
      const Grid grid = divide_box(scene, levels);
      EXPECT_EQ(grid.fraction(), std::min(23, 39 - levels));
      EXPECT_LE(grid.levels + grid.fraction(), 39);
    }
  }
}

}  // namespace
}  // namespace svdag
