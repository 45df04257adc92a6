#include "io/grid.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

#include "io/lattice.h"
#include "tests/any_of.h"
#include "tests/expect_error.h"
#include "tests/io/generators.h"

namespace svdag {
namespace {

Box box_of(const Point& a, const Point& b) {
  Box box;
  box.add(a);
  box.add(b);
  return box;
}

TEST(FractionBits, AreMin23And39MinusLAndFit128BitTests) {
  for (int levels = kMinLevels; levels <= kMaxLevels; ++levels) {
    EXPECT_EQ(fraction_bits(levels), levels <= 16 ? 23 : 39 - levels) << levels;
    EXPECT_LE(levels + fraction_bits(levels), 39);
    Grid grid;
    grid.levels = levels;
    EXPECT_EQ(grid.fraction(), fraction_bits(levels));
    EXPECT_EQ(grid.resolution(), int64_t(1) << levels);
  }
}

RC_GTEST_PROP(DividedBox, HasItsOutermostFacesMidVoxel, ()) {
  const Box box = *boxes();
  const Grid grid = divide_box(box, *level_counts());
  const Lattice lattice(grid);
  const LatticePoint low = lattice.snap(box.min), high = lattice.snap(box.max);
  const int64_t half = int64_t(1) << (grid.fraction() - 1);
  bool fills_an_axis = false;
  for (int a = 0; a < 3; ++a) {
    // The origin is rounded in world units: far from zero that is more than one lattice step.
    const double world = std::max(std::abs(box.min[a]), std::abs(box.max[a]));
    const double slack =
        2 + 4 * 0x1p-52 * world / grid.voxel_size * std::ldexp(1.0, grid.fraction());
    RC_ASSERT(std::abs(double(low[a] - half)) <= slack);
    const int64_t end = (grid.resolution() << grid.fraction()) - half;
    RC_ASSERT(double(high[a] - end) <= slack);
    fills_an_axis = fills_an_axis || std::abs(double(high[a] - end)) <= slack;
  }
  RC_ASSERT(fills_an_axis);
  RC_ASSERT(grid.selection == grid.whole());
}

TEST(DividedBox, WithoutExtentOrNormalVoxelSizeIsAUsageError) {
  EXPECT_SVDAG_ERROR(divide_box(box_of({1, 2, 3}, {1, 2, 3}), 10), ExitCode::kUsage,
                     "voxel size would be 0");
  EXPECT_SVDAG_ERROR(divide_box(box_of({0, 0, 0}, {1e-306, 0, 0}), 12), ExitCode::kUsage,
                     "not a positive normal");
  EXPECT_SVDAG_ERROR(divide_box(box_of({-1.5e308, 0, 0}, {1.5e308, 0, 0}), 3), ExitCode::kUsage,
                     "would be inf");
}

TEST(CoveredLattice, RejectsVoxelSizesThatAreNotPositiveNormalNumbers) {
  const Box box = box_of({0, 0, 0}, {1, 1, 1});
  for (const double size : {0.0, -1.0, 1e-310, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()})
    EXPECT_SVDAG_ERROR(cover_lattice(box, size), ExitCode::kUsage, "not a positive normal number");
}

TEST(CoveredLattice, IsNoLargerThanASmallSceneNeeds) {
  EXPECT_EQ(cover_lattice(box_of({0, 0, 0}, {10, 10, 10}), 1).resolution(), 32);
  EXPECT_EQ(cover_lattice(box_of({-5, -5, -5}, {5, 5, 5}), 1).resolution(), 16);
  EXPECT_EQ(cover_lattice(box_of({4090, 0, 0}, {4100, 1, 1}), 1).resolution(), 16);
}

TEST(CoveredLattice, NamesTheSmallestVoxelSize) {
  const Box box = box_of({0, 0, 0}, {123.4, 1, 1});
  EXPECT_SVDAG_ERROR(cover_lattice(box, 1e-6), ExitCode::kUsage, "voxels of at least 0.00012,");
  EXPECT_EQ(cover_lattice(box, 0.00012).levels, kMaxLevels);
}

TEST(DividedCube, HasItsCornersAtThoseOfTheCube) {
  const GridCube cube{{-1, 2, 3}, 6};
  for (int levels = kMinLevels; levels <= kMaxLevels; ++levels) {
    const Grid grid = divide_cube(cube, levels);
    EXPECT_EQ(grid.corner(), cube.min);
    EXPECT_EQ(grid.voxel_size * double(grid.resolution()), cube.side);
    EXPECT_TRUE(grid.bounded && grid.is_valid());
    EXPECT_EQ(grid.selection, grid.whole());
  }
  for (const double side : {0.0, -1.0, 1e-310, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_SVDAG_ERROR(divide_cube({Point(0), side}, 3), ExitCode::kUsage, "--cube: the side");
}

// So the snapped scene, and with it every conservative voxel, is the same at these resolutions.
RC_GTEST_PROP(DividedCube, SnapsTheSameFrom64KOn, ()) {
  const Box box = *boxes();
  const double side = std::abs(box.max.x - box.min.x) + std::abs(box.max.y - box.min.y);
  RC_PRE(std::isnormal(side * 0x1p-40) && std::isfinite(side));
  const GridCube cube{box.min, side};
  const Lattice coarse(divide_cube(cube, 16)), fine(divide_cube(cube, *any_of(17, 20)));
  for (const Point& p : {box.min, box.max, 0.3 * box.min + 0.7 * box.max}) {
    LatticePoint q;
    try {
      q = coarse.snap(p);
    } catch (const Error&) {
      RC_DISCARD("too far from the cube");
    }
    RC_ASSERT(q == fine.snap(p));
  }
}

TEST(CoveredLattice, RejectsMoreThanAMillionVoxels) {
  EXPECT_SVDAG_ERROR(cover_lattice(box_of({0, 0, 0}, {2e6, 1, 1}), 1), ExitCode::kUsage,
                     "more than 1M voxels");
  EXPECT_SVDAG_ERROR(cover_lattice(box_of({0, 0, 0}, {1e300, 1, 1}), 1e-300), ExitCode::kUsage,
                     "away from zero");
}

RC_GTEST_PROP(CoveredLattice, IsTheSmallestThatHoldsEveryTouchedVoxel, ()) {
  const Box box = *boxes();
  const double size = divide_box(box, *any_of(3, 18)).voxel_size;
  const Grid grid = cover_lattice(box, size);
  const Lattice lattice(grid);
  const LatticePoint low = lattice.snap(box.min), high = lattice.snap(box.max);
  bool needed = grid.levels == kMinLevels;
  for (int a = 0; a < 3; ++a) {
    const int64_t step = corner_step(grid.levels);
    const int64_t first = lattice.first_voxel(low[a]), last = lattice.last_voxel(high[a]);
    RC_ASSERT(grid.k0[a] % step == 0);
    RC_ASSERT(first >= 0 && first < step);
    RC_ASSERT(last < grid.resolution());
    // One level less does not suffice on some axis. Its finer lattice may move q by one voxel.
    const int64_t corner = first & -corner_step(grid.levels - 1);
    needed = needed || last - corner >= grid.resolution() / 2 - 1;
  }
  RC_ASSERT(needed);
}

TEST(Grid, ACornerBeyondTheFarthestPlaneIsInvalid) {
  Grid grid = cover_lattice(box_of({0, 0, 0}, {5, 5, 5}), 1);
  for (const int64_t sign : {-1, 1}) {
    grid.k0.y = sign * kFarthestPlane;
    EXPECT_TRUE(grid.is_valid());
    grid.k0.y += sign;
    EXPECT_FALSE(grid.is_valid());
  }
}

TEST(SelectedBounds, MayBeOutsideTheRangeOfTheSnap) {
  const double far = 1e300;
  Grid corner = cover_lattice(box_of({0, 0, 0}, {5, 5, 5}), 1);
  corner.k0 = LatticePoint(kFarthestPlane);
  for (const Grid& grid : {divide_box(box_of({7, 7, 7}, {22, 22, 22}), 17), corner}) {
    EXPECT_EQ(select_bounds(grid, box_of({-far, -far, -far}, {far, far, far})).selection,
              grid.whole());
    EXPECT_TRUE(select_bounds(grid, box_of({-far, -far, far}, {far, far, far})).selection.empty());
    EXPECT_TRUE(
        select_bounds(grid, box_of({-far, -far, -far}, {far, -far, far})).selection.empty());
  }
}

// Brute force: does the open voxel meet the closed interval?
RC_GTEST_PROP(SelectedBounds, AreTheVoxelsWhoseInteriorMeetsTheBox, ()) {
  Grid grid = divide_box(box_of({0, 0, 0}, {15, 15, 15}), 4);  // voxels of size 1 from -1/2
  const auto quarter = [] { return double(*any_of(-12, 80)) / 4; };
  const Box bounds = box_of({quarter(), quarter(), quarter()}, {quarter(), quarter(), quarter()});
  const Grid selected = select_bounds(grid, bounds);
  RC_ASSERT(selected.bounded);
  bool empty = false;
  for (int a = 0; a < 3; ++a) {
    int meeting = 0;
    for (int k = 0; k < 16; ++k) meeting += k - 0.5 < bounds.max[a] && k + 0.5 > bounds.min[a];
    empty = empty || meeting == 0;
  }
  RC_ASSERT(selected.selection.empty() == empty);
  if (empty) {
    RC_ASSERT(selected.selection == VoxelBox{});
  } else {
    for (int a = 0; a < 3; ++a)
      for (int k = 0; k < 16; ++k)
        RC_ASSERT((k - 0.5 < bounds.max[a] && k + 0.5 > bounds.min[a]) ==
                  (selected.selection.min[a] <= k && k < selected.selection.max[a]));
  }
  grid.selection = selected.selection;
  grid.bounded = true;
  RC_ASSERT(grid == selected);  // the grid did not move
}

TEST(Corner, IsTheWorldPositionOfTheFirstVoxelsCorner) {
  Grid grid = divide_box(box_of({0, 0, 0}, {7, 7, 7}), 3);
  EXPECT_EQ(grid.corner(), Point(-0.5));
  grid = cover_lattice(box_of({3000, 0, -3000}, {3001, 1, -2999}), 1);
  EXPECT_EQ(grid.corner(), Point(2996.5, -3.5, -3003.5));
}

}  // namespace
}  // namespace svdag
