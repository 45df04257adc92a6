// Tests that grids with permuted and mirrored axes are mapped to ours, and that all others are
// rejected.
#include "verify/compare/index_map.h"

#include <gtest/gtest.h>

#include <cmath>

#include "io/dag/dag_level.h"
#include "tests/expect_error.h"
#include "tests/verify/fake_vdb.h"

namespace svdag {
namespace {

FakeVdb fake(const IndexToWorld& centres, int64_t reach = 64) {
  return FakeVdb(centres, {{0, 0, 0}, {reach - 1, reach - 1, reach - 1}});
}

TEST(IndexMap, All48OrientationsAreFound) {
  const Grid grid = test_grid(6);
  std::array<int, 3> axis{0, 1, 2};
  do {
    for (int mirror = 0; mirror < 8; ++mirror) {
      const std::array<int, 3> sign{mirror & 1 ? -1 : 1, mirror & 2 ? -1 : 1, mirror & 4 ? -1 : 1};
      const LatticePoint zero(5, -70, 1000);
      const GridFit fit = fit_grid(fake(turned_centres(grid, axis, sign, zero)), grid, "x");
      EXPECT_EQ(fit.levels, 6);
      EXPECT_EQ(fit.map({0, 0, 0}), zero);
      for (int a = 0; a < 3; ++a) {
        LatticePoint theirs(0), ours = zero;
        theirs[a] = 3;
        ours[axis[size_t(a)]] += 3 * sign[size_t(a)];
        EXPECT_EQ(fit.map(theirs), ours);
        EXPECT_EQ(fit.map.back(ours), theirs);
      }
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
}

TEST(IndexMap, ABoxIsMappedVoxelByVoxel) {
  const Grid grid = test_grid(6);
  const auto centres = turned_centres(grid, {2, 0, 1}, {-1, 1, -1}, {60, 3, 50});
  const IndexMap map = fit_grid(fake(centres), grid, "x").map;
  const VoxelBox box{{1, 2, 3}, {4, 8, 10}};
  const VoxelBox image = map(box);
  EXPECT_EQ(image.max - image.min, LatticePoint(6, 7, 3));
  EXPECT_TRUE(holds(image, map({1, 2, 3})) && holds(image, map({3, 7, 9})));
  EXPECT_EQ(map.back(image), box);
}

TEST(IndexMap, TheLevelWithVoxelsOfTheSameSizeIsChosen) {
  const Grid grid = test_grid(6);
  for (int levels = 3; levels <= 6; ++levels)
    EXPECT_EQ(fit_grid(fake(voxel_centres(level_grid(grid, levels))), grid, "x").levels, levels);
}

TEST(IndexMap, AShiftByHalfAVoxelIsRejected) {
  const Grid grid = test_grid(6);
  IndexToWorld centres = voxel_centres(grid);
  centres.origin = grid.corner();  // their centres are our corners
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage,
                     "its voxel centres are (");
}

TEST(IndexMap, AScaleErrorThatAddsUpOverTheGridIsRejected) {
  const Grid grid = test_grid(6);
  IndexToWorld centres = voxel_centres(grid);
  for (Point& axis : centres.axes) axis *= 1 + 1e-7;
  EXPECT_EQ(fit_grid(fake(centres, 1000), grid, "x").levels, 6);  // 0.0001 voxels at the far end
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres, 1'000'000), grid, "x"), ExitCode::kUsage, "away from");
}

// The grid of a cubic scene with this corner and size.
Grid grid_at(const Point& low, double size, int levels) {
  return divide_box({low, low + size}, levels);
}

TEST(IndexMap, OurOwnCentresFitAtAnyPosition) {
  // At 1e12 a voxel of 1/64K is smaller than a step of a double.
  for (const Point low : {Point(1e12, 0, 5), Point(-1e15, 1e6, 0.1), Point(1841111.4, 5e6, -191)}) {
    for (const int levels : {10, 16, 20}) {
      const Grid grid = grid_at(low, 1, levels);
      for (const int own : {levels, levels - 1, kMinLevels}) {
        const int64_t side = int64_t(1) << own;
        const GridFit fit = fit_grid(fake(voxel_centres(level_grid(grid, own)), side), grid, "x");
        EXPECT_EQ(fit.levels, own);
        EXPECT_FALSE(fit.map.changes_axes());
        EXPECT_EQ(fit.map.shift, LatticePoint(0));
      }
    }
  }
}

TEST(IndexMap, AnySizeWithinTheRangeOfDoubleFits) {
  for (const double size : {1e-300, 1e-160, 1e160, 1e300}) {
    const Grid grid = grid_at(Point(size, 0, -size), size, 10);
    const auto centres = turned_centres(grid, {2, 0, 1}, {-1, 1, -1}, {60, 3, 50});
    EXPECT_EQ(fit_grid(fake(centres), grid, "x").map({0, 0, 0}), LatticePoint(60, 3, 50));
    IndexToWorld wider = centres;
    for (Point& axis : wider.axes) axis *= 1.5;
    EXPECT_SVDAG_ERROR(fit_grid(fake(wider), grid, "x"), ExitCode::kUsage, "no level of it");
  }
}

TEST(IndexMap, AFewRoundingsFitButAQuarterOfAVoxelDoesNot) {
  const double low = 1e11;
  const Grid grid = grid_at(Point(low, 0, 0), 1, 10);
  const double step = std::nextafter(low, 2 * low) - low;
  ASSERT_GT(2 * step / grid.voxel_size, 10 * kCentreTolerance);
  IndexToWorld centres = voxel_centres(grid);
  centres.origin.x += 2 * step;
  EXPECT_EQ(fit_grid(fake(centres), grid, "x").map.shift, LatticePoint(0));
  centres.origin.x += grid.voxel_size;
  EXPECT_EQ(fit_grid(fake(centres), grid, "x").map.shift, LatticePoint(1, 0, 0));
  centres.origin.x += grid.voxel_size / 4;
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage,
                     "voxel centres are (0.2");
}

TEST(IndexMap, RoundingsOfHalfAVoxelAreRejected) {
  const Grid grid = grid_at(Point(1e12, 0, 0), 1, 12);
  IndexToWorld centres = voxel_centres(grid);
  centres.origin.x = std::nextafter(centres.origin.x, 2e12);  // half a voxel
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "voxel centres are (");
}

TEST(IndexMap, OtherSizesRotationsAndShearsAreRejected) {
  const Grid grid = test_grid(6);
  IndexToWorld centres = voxel_centres(grid);
  for (Point& axis : centres.axes) axis *= 3.0;
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "are 1.5 wide");
  centres = voxel_centres(grid);
  for (Point& axis : centres.axes) axis *= 0.5;
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "no level of it");
  centres = voxel_centres(grid);
  centres.axes[1] = Point(0.3, 0.4, 0);
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "rotated");
  centres.axes[1] = centres.axes[0];
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "rotated");
}

}  // namespace
}  // namespace svdag
