// The voxelizer, through its window interface, against closed forms and against the clipping judge
// of verify/.
#include "builder/descend/voxelize_window.h"

#include <gtest/gtest.h>

#include <bit>
#include <map>
#include <random>

#include "verify/judge/clip_judge.h"

namespace svdag {
namespace {

constexpr int kWindowF = 23;
constexpr int64_t kWindowVoxel = int64_t(1) << kWindowF;
constexpr int64_t kHalf = kWindowVoxel / 2;

Grid window_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = 1;
  grid.selection = grid.whole();
  return grid;
}

LatticePoint lattice_point(double x, double y, double z) {
  return {int64_t(x * double(kWindowVoxel)), int64_t(y * double(kWindowVoxel)), int64_t(z * double(kWindowVoxel))};
}

uint64_t count_voxels(const std::vector<LatticeTriangle>& triangles, int levels = 6) {
  uint64_t voxels = 0;
  const uint64_t total =
      voxelize_window(window_grid(levels), {}, Cube(), triangles,
                      [&](const LatticePoint&, Brick b) { voxels += uint64_t(std::popcount(b)); });
  EXPECT_EQ(total, voxels);
  return voxels;
}

std::vector<LatticeTriangle> box(const LatticePoint& low, const LatticePoint& size) {
  static constexpr int kFaces[6][4] = {{0, 1, 3, 2}, {4, 6, 7, 5}, {0, 4, 5, 1},
                                       {2, 3, 7, 6}, {0, 2, 6, 4}, {1, 5, 7, 3}};
  const auto corner = [&](int i) {
    return low + LatticePoint(i & 4 ? size.x : 0, i & 2 ? size.y : 0, i & 1 ? size.z : 0);
  };
  std::vector<LatticeTriangle> out;
  for (const auto& f : kFaces) {
    out.push_back({{corner(f[0]), corner(f[1]), corner(f[2])}});
    out.push_back({{corner(f[0]), corner(f[2]), corner(f[3])}});
  }
  return out;
}

TEST(Window, APointSetsTheVoxelsThatItTouches) {
  const auto point = [](double x, double y, double z) {
    const LatticePoint p = lattice_point(x, y, z);
    return count_voxels({{{p, p, p}}});
  };
  EXPECT_EQ(point(5, 5, 5), 8U);
  EXPECT_EQ(point(5.5, 5, 5), 4U);
  EXPECT_EQ(point(5.5, 5, 5.25), 2U);
  EXPECT_EQ(point(5.5, 5.75, 5.25), 1U);
  EXPECT_EQ(point(0, 0, 0), 1U);     // corner of the grid
  EXPECT_EQ(point(64, 64, 64), 1U);  // the opposite corner is closed too
}

TEST(Window, ABoxOnVoxelPlanesHasWallsOfTwoVoxels) {
  for (const auto& [a, b, c] : {std::array{5, 7, 9}, std::array{4, 16, 32}, std::array{31, 5, 8}}) {
    const uint64_t voxels = uint64_t((a + 2) * (b + 2) * (c + 2) - (a - 2) * (b - 2) * (c - 2));
    EXPECT_EQ(count_voxels(box(lattice_point(8, 9, 10), lattice_point(a, b, c))), voxels);
  }
}

TEST(Window, ABoxOffVoxelPlanesHasWallsOfOneVoxel) {
  for (const auto& [a, b, c] : {std::array{5, 7, 9}, std::array{4, 16, 32}}) {
    const uint64_t voxels = uint64_t((a + 1) * (b + 1) * (c + 1) - (a - 1) * (b - 1) * (c - 1));
    EXPECT_EQ(count_voxels(box(lattice_point(8.5, 9.25, 10.75), lattice_point(a, b, c))), voxels);
  }
}

TEST(Window, TheCornerTriangleHasItsClosedForm) {
  for (const int64_t c : {1, 2, 3, 8, 17, 40}) {
    const int64_t s = c * kWindowVoxel;
    const LatticeTriangle t{{LatticePoint(s, 0, 0), LatticePoint(0, s, 0), LatticePoint(0, 0, s)}};
    // The closed form counts voxels of all space; move the triangle inside the grid.
    LatticeTriangle moved = t;
    for (LatticePoint& p : moved.v) p += LatticePoint(4 * kWindowVoxel);
    EXPECT_EQ(count_voxels({moved}), uint64_t(2 * c * c + 9 * c + 8)) << c;
  }
}

TEST(Window, ADiagonalOfCollinearVerticesHasItsClosedForm) {
  for (const int64_t n : {1, 2, 5, 30}) {
    const LatticePoint low(4 * kWindowVoxel), high((4 + n) * kWindowVoxel), middle((low + high) / int64_t(2));
    EXPECT_EQ(count_voxels({{{low, high, middle}}}), uint64_t(7 * n + 8)) << n;
    EXPECT_EQ(count_voxels({{{middle, low, high}}}), uint64_t(7 * n + 8)) << n;
    EXPECT_EQ(count_voxels({{{low, high, high}}}), uint64_t(7 * n + 8)) << n;
  }
}

TEST(Window, TheSelectionClearsEverythingElse) {
  Grid grid = window_grid(6);
  grid.bounded = true;
  grid.selection = {LatticePoint(9, 10, 11), LatticePoint(23, 22, 21)};
  uint64_t outside = 0, inside = 0;
  voxelize_window(grid, {}, Cube(), box(lattice_point(5.5, 5.5, 5.5), lattice_point(12, 13, 14)),
                  [&](const LatticePoint& at, Brick b) {
                    for (unsigned i = 0; i < 64; ++i) {
                      const LatticePoint v(4 * at.x + i / 16, 4 * at.y + i / 4 % 4,
                                           4 * at.z + i % 4);
                      const bool set = b >> brick_bit(i / 16, i / 4 % 4, i % 4) & 1;
                      bool in = true;
                      for (int a = 0; a < 3; ++a)
                        in = in && v[a] >= grid.selection.min[a] && v[a] < grid.selection.max[a];
                      (in ? inside : outside) += set;
                    }
                  });
  EXPECT_EQ(outside, 0U);
  EXPECT_GT(inside, 100U);
}

// ---- against the judge ----

using VoxelBricks = std::map<std::array<int64_t, 3>, Brick>;

VoxelBricks by_judge(const Grid& grid, const Cube& window,
                const std::vector<LatticeTriangle>& triangles) {
  const int side = 1 << (grid.levels - window.level);
  const LatticePoint low = window.coordinate * int64_t(side);
  VoxelBricks voxels;
  Clipper clipper;
  for (const LatticeTriangle& t : triangles) {
    clipper.run(t, grid.fraction(), {low, low + LatticePoint(side)}, [&](const CellRun& run) {
      LatticePoint p = run.first;
      for (int64_t i = 0; i < run.count; ++i, ++p[run.axis])
        voxels[{p.x >> 2, p.y >> 2, p.z >> 2}] |=
            Brick(1) << brick_bit(unsigned(p.x & 3), unsigned(p.y & 3), unsigned(p.z & 3));
    });
  }
  return voxels;
}

// Returns the number of bricks with a set voxel.
size_t expect_same(const Grid& grid, const Cube& window,
                   const std::vector<LatticeTriangle>& triangles, const char* family) {
  VoxelBricks ours;
  voxelize_window(grid, {}, window, triangles, [&](const LatticePoint& at, Brick b) {
    ours[{at.x, at.y, at.z}] = b;
  });
  EXPECT_EQ(ours, by_judge(grid, window, triangles)) << family;
  return ours.size();
}

struct Family {
  const char* name;
  int64_t step;    // coordinates are multiples of this
  int64_t extent;  // of a triangle, in lattice units
};

class WindowAgainstJudge : public ::testing::TestWithParam<Family> {};

TEST_P(WindowAgainstJudge, GivesTheSameVoxelsAtEveryDepth) {
  const Family family = GetParam();
  std::mt19937_64 random(7);
  const auto draw = [&](int64_t range) {
    return int64_t(random() % uint64_t(2 * range + 1)) - range;
  };
  size_t bricks = 0;
  for (const int levels : {6, 10, 16}) {
    const Grid grid = window_grid(levels);
    for (int round = 0; round < 40; ++round) {
      // A window of 32^3 voxels somewhere in the grid, triangles around it.
      Cube window{levels - 5, LatticePoint(0)};
      for (int a = 0; a < 3; ++a)
        window.coordinate[a] = int64_t(random() % (uint64_t(1) << (levels - 5)));
      const LatticePoint centre = window.corner(levels) + LatticePoint(16 * kWindowVoxel);
      std::vector<LatticeTriangle> triangles(20);
      for (LatticeTriangle& t : triangles) {
        // Two corners around a point near the window and the third opposite, so that even giant
        // triangles meet the window.
        for (int a = 0; a < 3; ++a) {
          const int64_t at = centre[a] + draw(18 * kWindowVoxel);
          const int64_t d0 = draw(family.extent), d1 = draw(family.extent);
          t.v[0][a] = (at + d0) / family.step * family.step;
          t.v[1][a] = (at + d1) / family.step * family.step;
          t.v[2][a] = (at - d0 - d1) / family.step * family.step;
        }
      }
      bricks += expect_same(grid, window, triangles, family.name);
    }
  }
  EXPECT_GT(bricks, 1000U);  // the triangles do meet the windows
}

INSTANTIATE_TEST_SUITE_P(Families, WindowAgainstJudge,
                         ::testing::Values(Family{"small", 1, 2 * kWindowVoxel}, Family{"tiny", 1, 100},
                                           Family{"medium", 1, 8 * kWindowVoxel},
                                           Family{"large", 1, 40 * kWindowVoxel},
                                           Family{"on_voxel_planes", kWindowVoxel, 6 * kWindowVoxel},
                                           Family{"on_half_planes", kHalf, 6 * kWindowVoxel},
                                           Family{"points_on_corners", kWindowVoxel, kWindowVoxel / 3},
                                           Family{"giant", 1, int64_t(1) << 36},
                                           Family{"giant_on_planes", kWindowVoxel, int64_t(1) << 38},
                                           Family{"wide", 1, int64_t(1) << 45},
                                           Family{"widest", 1, int64_t(1) << 60}),
                         [](const auto& instance) { return std::string(instance.param.name); });

TEST(WindowAgainstJudge, SliversGiveTheSameVoxels) {
  std::mt19937_64 random(3);
  const auto draw = [&](int64_t range) {
    return int64_t(random() % uint64_t(2 * range + 1)) - range;
  };
  for (const int64_t width : {int64_t(0), int64_t(1), int64_t(40), kWindowVoxel / 7}) {
    for (int round = 0; round < 300; ++round) {
      const Grid grid = window_grid(6);
      LatticeTriangle t;
      for (size_t i = 0; i < 2; ++i)
        t.v[i] = LatticePoint(32 * kWindowVoxel) +
                 LatticePoint(draw(30 * kWindowVoxel), draw(30 * kWindowVoxel), draw(30 * kWindowVoxel));
      t.v[2] = (t.v[0] + t.v[1]) / int64_t(2) + LatticePoint(draw(width), draw(width), draw(width));
      expect_same(grid, Cube(), {t}, "sliver");
    }
  }
}

TEST(WindowAgainstJudge, PlanesThroughVoxelCornersGiveTheSameVoxels) {
  // x + y + z = c: every voxel corner near it decides a tie.
  for (const int64_t c : {20, 33, 47}) {
    const int64_t s = c * kWindowVoxel;
    for (const int64_t nudge : {-1, 0, 1}) {
      const LatticeTriangle t{{LatticePoint(s + nudge, 0, 0), LatticePoint(0, s + nudge, 0),
                               LatticePoint(0, 0, s + nudge)}};
      expect_same(window_grid(6), Cube(), {t}, "x+y+z=c");
    }
  }
}

}  // namespace
}  // namespace svdag
