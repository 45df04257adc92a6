// Grids lie on ours with swapped and mirrored axes, and nothing that is off by more is let through.
#include "verify/index_map.h"

#include <gtest/gtest.h>

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

TEST(IndexMap, TheLevelWithVoxelsOfThatSizeIsChosen) {
  const Grid grid = test_grid(6);
  for (int levels = 3; levels <= 6; ++levels)
    EXPECT_EQ(fit_grid(fake(voxel_centres(level_grid(grid, levels))), grid, "x").levels, levels);
}

TEST(IndexMap, AHalfVoxelIsRefused) {
  const Grid grid = test_grid(6);
  IndexToWorld centres = voxel_centres(grid);
  centres.origin = grid.corner();  // centres where our corners are
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage,
                     "its voxel centres are (");
}

TEST(IndexMap, AScaleThatDriftsOverTheWholeGridIsRefused) {
  const Grid grid = test_grid(6);
  IndexToWorld centres = voxel_centres(grid);
  for (Point& axis : centres.axes) axis *= 1 + 1e-7;
  EXPECT_EQ(fit_grid(fake(centres, 1000), grid, "x").levels, 6);  // 0.0001 voxel at its end
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres, 1'000'000), grid, "x"), ExitCode::kUsage, "away from");
}

TEST(IndexMap, OtherSizesTurnsAndShearsAreRefused) {
  const Grid grid = test_grid(6);
  IndexToWorld centres = voxel_centres(grid);
  for (Point& axis : centres.axes) axis *= 3.0;
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "are 1.5 wide");
  centres = voxel_centres(grid);
  for (Point& axis : centres.axes) axis *= 0.5;
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "no level of it");
  centres = voxel_centres(grid);
  centres.axes[1] = Point(0.3, 0.4, 0);
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "turned");
  centres.axes[1] = centres.axes[0];
  EXPECT_SVDAG_ERROR(fit_grid(fake(centres), grid, "x"), ExitCode::kUsage, "turned");
}

}  // namespace
}  // namespace svdag
