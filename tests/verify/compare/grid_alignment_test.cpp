// Tests that grids match up to rounding, and up to float32 where a file may have stored that.
#include "verify/compare/grid_alignment.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/dag/dag_level.h"

namespace svdag {
namespace {

// Not a float32, and no voxel size derived from it below is one.
constexpr double kGridSide = 1.1;

Box cube(double low, double side = kGridSide) {
  return {Point(low, low / 2, -low), Point(low + side, low / 2 + side, -low + side)};
}

Grid bake(int levels, double low = 0.3) {
  return divide_box(cube(low), levels);
}

Grid moved(Grid grid, double voxels, int axis = 1) {
  grid.origin[axis] += voxels * grid.voxel_size;
  return grid;
}

Grid scaled(Grid grid, double factor) {
  grid.voxel_size *= factor;
  return grid;
}

// Rounds the corners of the box and the side to float32, as SymVox stores them.
Grid stored_as_float32(Grid grid) {
  const double side = std::ldexp(grid.voxel_size, grid.levels);
  for (int axis = 0; axis < 3; ++axis) {
    const double middle =
        (double(float(grid.origin[axis])) + double(float(grid.origin[axis] + side))) / 2;
    grid.origin[axis] = middle - double(float(side)) / 2;
  }
  grid.voxel_size = std::ldexp(double(float(side)), -grid.levels);
  return grid;
}

// Checks that the result does not depend on the order.
bool same(const Grid& a, const Grid& b) {
  EXPECT_EQ(same_place(a, b), same_place(b, a));
  return same_place(a, b);
}

TEST(SamePlace, OneResolutionAllowsAMillionthOfAVoxel) {
  for (const int levels : {3, 10, 20}) {
    const Grid grid = bake(levels);
    EXPECT_TRUE(same(grid, grid));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_TRUE(same(grid, moved(grid, 0.5e-6, axis)));
      for (const double voxels : {2e-6, 0.01, 0.5, 0.92, 1.0, -0.92})
        EXPECT_FALSE(same(grid, moved(grid, voxels, axis))) << voxels;
    }
    // The far end of the grid moves by N times the difference in voxel size.
    const double n = double(grid.resolution());
    EXPECT_TRUE(same(grid, scaled(grid, 1 + 0.5e-6 / n)));
    for (const double voxels : {3e-6, 0.5, 0.9})
      EXPECT_FALSE(same(grid, scaled(grid, 1 + voxels / n))) << voxels;
  }
  EXPECT_FALSE(same(bake(10), scaled(bake(10), 1.0005)));
}

TEST(SamePlace, DivisionsOfOneBoxMatchAtAnyTwoResolutions) {
  for (const double low : {0.0, 0.3, -7.7, 1e6}) {
    for (int a = kMinLevels; a <= kMaxLevels; ++a) {
      for (int b = kMinLevels; b <= a; ++b) EXPECT_TRUE(same(bake(a, low), bake(b, low)));
    }
  }
}

TEST(SamePlace, DivisionsOfDifferentBoxesDoNotMatch) {
  const Grid fine = bake(10), coarse = bake(9);
  for (const double voxels : {1e-5, 0.25, 0.5, -0.5, 1.0})
    EXPECT_FALSE(same(fine, moved(coarse, voxels))) << voxels;
  EXPECT_FALSE(same(fine, divide_box(cube(0.3, kGridSide * 1.0005), 9)));
  EXPECT_FALSE(same(fine, divide_box(cube(0.3, kGridSide * 1.00001), 9)));
}

TEST(SamePlace, AGridMatchesItsLevels) {
  const Grid fine = bake(10), level = level_grid(fine, 8);
  EXPECT_TRUE(same(fine, level));
  EXPECT_FALSE(same(fine, moved(level, 1e-5)));
  EXPECT_FALSE(same(fine, scaled(level, 1 + 1e-6)));
  // A bake of that resolution has another grid.
  EXPECT_FALSE(same(level, bake(8)));
}

TEST(SamePlace, LatticesMatchAtTwiceTheVoxelSize) {
  const Box box = {Point(1, 2, 3), Point(70, 71, 72)};
  const Grid fine = cover_lattice(box, 0.1), coarse = cover_lattice(box, 0.2);
  ASSERT_EQ(fine.levels, coarse.levels + 1);
  EXPECT_TRUE(same(fine, coarse));
  EXPECT_FALSE(same(fine, cover_lattice(box, 0.2001)));
  Grid next = coarse;
  next.k0.x += 1024;
  EXPECT_FALSE(same(fine, next));
}

// An alignment applies only to grids of its kind; otherwise grids could match by accident.
TEST(SamePlace, BoxesAndLatticesAreNotMixed) {
  Grid fine = bake(10), coarse = bake(10);
  fine.origin = Point(-0.25);
  fine.voxel_size = 0.5;
  coarse.levels = 9;
  coarse.origin = Point(0);
  coarse.voxel_size = 1;
  const auto kinds = [&](Grid::Kind a, Grid::Kind b) {
    fine.kind = a;
    coarse.kind = b;
    return same(fine, coarse);
  };
  // As boxes, the first centres are 0 and 1/2; as lattices, both have a plane at -1/2.
  EXPECT_FALSE(kinds(Grid::Kind::kBox, Grid::Kind::kBox));
  EXPECT_FALSE(kinds(Grid::Kind::kBox, Grid::Kind::kLattice));
  EXPECT_FALSE(kinds(Grid::Kind::kLattice, Grid::Kind::kBox));
}

TEST(SamePlace, FarFromZeroAWholeVoxelIsNotRounding) {
  for (const double corner : {0x1p50, 0x1p51, 0x1p52}) {
    Grid grid = bake(3);
    grid.voxel_size = 1;
    grid.origin = Point(corner);
    EXPECT_TRUE(same(grid, grid));
    for (const double voxels : {1.0, 2.0, 4.0}) EXPECT_FALSE(same(grid, moved(grid, voxels)));
  }
  Grid beyond = bake(3);  // the quotient of corner and size overflows
  beyond.origin = Point(1e300);
  beyond.voxel_size = 1e-300;
  EXPECT_TRUE(same(beyond, beyond));
}

TEST(SamePlace, NearZeroFloat32PositionsMatch) {
  for (const double low : {0.0, 0.3, -kGridSide / 2, -7.7}) {
    for (const int levels : {3, 10, 16}) {
      const Grid grid = bake(levels, low), stored = stored_as_float32(grid);
      EXPECT_TRUE(same(grid, stored)) << low << ", " << levels;
      EXPECT_FALSE(same(grid, moved(stored, 0.2)));
    }
  }
  const Grid middle = bake(20, -kGridSide / 2);
  EXPECT_TRUE(same(middle, stored_as_float32(middle)));
  EXPECT_TRUE(same(bake(16), stored_as_float32(level_grid(bake(16), 12))));
}

TEST(SamePlace, Float32ErrorsOfOtherGridsDoNotMatch) {
  // Between two bakes the same distance cannot be rounding.
  const Grid grid = bake(16), stored = stored_as_float32(grid);
  const double voxels = (stored.origin.y - grid.origin.y) / grid.voxel_size;
  ASSERT_GT(std::abs(voxels), 1e-5);
  EXPECT_FALSE(same(grid, moved(grid, voxels)));
}

TEST(SamePlace, Float32PositionsFarFromZeroDoNotMatch) {
  const Grid grid = bake(16, 1e5), stored = stored_as_float32(grid);
  ASSERT_GT(std::abs(stored.origin.x - grid.origin.x), grid.voxel_size / 8);
  EXPECT_FALSE(same(grid, stored));
}

TEST(SamePlace, HugeAndTinyGridsMatchThemselves) {
  for (const double side : {1e-290, 1e300}) {
    const Grid grid = divide_box({Point(0), Point(side)}, 20);
    EXPECT_TRUE(same(grid, grid));
    EXPECT_FALSE(same(grid, moved(grid, 0.1)));
  }
}

}  // namespace
}  // namespace svdag
