// Closed forms for the number of voxels that simple bodies set, at any size and position.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "tests/stress/family.h"

namespace svdag {
namespace {

constexpr int kFormGrids[4] = {10, 13, 16, 20};

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
  for (const int levels : kFormGrids) {
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

// The twelve triangles of a box, with their front outside.
Soup box(const LatticePoint& low, const LatticePoint& size) {
  Soup soup;
  for (int w = 0; w < 3; ++w) {
    LatticePoint u(0), v(0), up(0);
    u[(w + 1) % 3] = size[(w + 1) % 3];
    v[(w + 2) % 3] = size[(w + 2) % 3];
    up[w] = size[w];
    soup.push_back({{low, low + u + v, low + u}});
    soup.push_back({{low, low + v, low + u + v}});
    soup.push_back({{low + up, low + up + u, low + up + u + v}});
    soup.push_back({{low + up, low + up + u + v, low + up + v}});
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

Soup turned(Soup soup) {
  for (LatticeTriangle& t : soup) std::swap(t.v[0], t.v[1]);
  return soup;
}

Soup both(Soup a, const Soup& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(ClosedForm, ASolidBoxHasNoHole) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const LatticePoint s = draw_size(random);
    const Soup on_planes = box(at, s * spot.voxel());
    const Soup off_planes = box(at + inside_voxel(spot, random), s * spot.voxel());
    for (const Rule rule : {Rule::kSolid, Rule::kSolidOdd}) {
      EXPECT_EQ(count_voxels(spot, rule, on_planes), product(s + int64_t(2)));
      EXPECT_EQ(count_voxels(spot, rule, off_planes), product(s + int64_t(1)));
    }
  });
}

TEST(ClosedForm, ShellsInABoxAreCavitiesOrNot) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const LatticePoint outer = draw_size(random) + int64_t(4), inner = outer - int64_t(4);
    const Soup shell = box(at, outer * spot.voxel());
    const Soup core = box(at + 2 * spot.voxel(), inner * spot.voxel());
    const uint64_t all = product(outer + int64_t(2)), hole = product(inner - int64_t(2));
    EXPECT_EQ(count_voxels(spot, Rule::kSolid, both(shell, core)), all);
    EXPECT_EQ(count_voxels(spot, Rule::kSolidOdd, both(shell, core)), all - hole);
    EXPECT_EQ(count_voxels(spot, Rule::kSolid, both(shell, turned(core))), all - hole);
    EXPECT_EQ(count_voxels(spot, Rule::kSolidOdd, both(shell, turned(core))), all - hole);
    // Two boxes that overlap, one inside out, cancel out where they overlap.
    EXPECT_EQ(count_voxels(spot, Rule::kSolid, both(shell, turned(shell))),
              count_voxels(spot, Rule::kConservative, shell));
  });
}

// The tetrahedron x, y, z >= 0, x + y + z <= c meets the cube of voxel (i, j, k) iff its corner
// that is nearest to the origin does: max(i, 0) + max(j, 0) + max(k, 0) <= c for i, j, k >= -1.
TEST(ClosedForm, ASolidTetrahedron) {
  everywhere([](const Spot& spot, StressRandom* random, const LatticePoint& at) {
    const int64_t c = random->between(1, 40), s = c * spot.voxel();
    const LatticePoint x(s, 0, 0), y(0, s, 0), z(0, 0, s);
    const Soup soup = {{{at, at + y, at + x}},
                       {{at, at + z, at + y}},
                       {{at, at + x, at + z}},
                       {{at + x, at + y, at + z}}};
    uint64_t voxels = 0;
    for (int64_t i = -1; i <= c; ++i) {
      for (int64_t j = -1; j <= c; ++j) {
        for (int64_t k = -1; k <= c; ++k)
          voxels +=
              std::max<int64_t>(i, 0) + std::max<int64_t>(j, 0) + std::max<int64_t>(k, 0) <= c;
      }
    }
    EXPECT_EQ(count_voxels(spot, Rule::kSolid, soup), voxels) << c;
    EXPECT_EQ(count_voxels(spot, Rule::kSolidOdd, soup), voxels) << c;
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
