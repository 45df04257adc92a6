// Tests of the full comparison: a correct file agrees, and every wrong voxel is found and located.
#include "verify/sample/compare.h"

#include <gtest/gtest.h>

#include "tests/verify/soup.h"

namespace svdag {
namespace {

Comparison compare(const Grid& grid, const std::vector<LatticeTriangle>& soup,
                   const VoxelSet& in_file, size_t threads = 1) {
  const RawFile file(raw_dag(grid, in_file));
  ParallelExecutor executor(threads);
  Progress progress;
  return compare_all(file.view(), grid, soup, {}, executor, progress);
}

TEST(Compare, CorrectFileAgreesOnEveryGrid) {
  for (int levels = 3; levels <= 8; ++levels) {
    const Grid grid = test_grid(levels);
    const auto soup = random_soup(grid, 60, uint64_t(levels), 20);
    const VoxelSet voxels = soup_voxels(grid, soup);
    const Comparison result = compare(grid, soup, voxels);
    EXPECT_TRUE(result.agrees()) << "missing " << result.missing << ", extra " << result.extra;
    EXPECT_EQ(result.judge_voxels, voxels.size());
    EXPECT_EQ(result.file_voxels, voxels.size());
  }
}

TEST(Compare, TrianglesAcrossManyTilesAgree) {
  const Grid grid = test_grid(8);
  const auto soup = random_soup(grid, 12, 5, 400);
  EXPECT_TRUE(compare(grid, soup, soup_voxels(grid, soup)).agrees());
}

TEST(Compare, ARemovedVoxelIsMissingAndAnAddedOneIsExtra) {
  const Grid grid = test_grid(7);
  const auto soup = random_soup(grid, 40, 3, 30);
  VoxelSet voxels = soup_voxels(grid, soup);
  const auto removed = *std::next(voxels.begin(), ptrdiff_t(voxels.size() / 2));
  voxels.erase(removed);
  const Comparison missing = compare(grid, soup, voxels);
  ASSERT_EQ(missing.missing, 1U);
  EXPECT_EQ(missing.extra, 0U);
  EXPECT_EQ(missing.wrong_bricks, 1U);
  const LatticePoint& at = missing.first.at(0).voxel;
  EXPECT_EQ(std::make_tuple(at.x, at.y, at.z), removed);
  EXPECT_TRUE(missing.first[0].missing);

  voxels.insert(removed);
  int64_t z = 0;
  while (voxels.count({100, 100, z}) != 0) ++z;
  voxels.emplace(100, 100, z);
  const Comparison extra = compare(grid, soup, voxels);
  EXPECT_EQ(extra.missing, 0U);
  ASSERT_EQ(extra.extra, 1U);
  EXPECT_EQ(extra.first.at(0).voxel, LatticePoint(100, 100, z));
  EXPECT_FALSE(extra.first[0].missing);
}

TEST(Compare, EmptyFileLacksEverything) {
  const Grid grid = test_grid(7);
  const auto soup = random_soup(grid, 10, 4, 30);
  const Comparison result = compare(grid, soup, {});
  EXPECT_EQ(result.missing, soup_voxels(grid, soup).size());
  EXPECT_GT(result.missing, 0U);
  EXPECT_LE(result.first.size(), Comparison::kShown);
}

TEST(Compare, OnlyTheSelectionCounts) {
  Grid grid = test_grid(7);
  grid.bounded = true;
  grid.selection = {LatticePoint(17, 30, 64), LatticePoint(90, 65, 128)};
  const auto soup = random_soup(grid, 80, 6, 40);
  const VoxelSet selected = soup_voxels(grid, soup);
  EXPECT_TRUE(compare(grid, soup, selected).agrees());
  Grid whole = grid;
  whole.selection = grid.whole();
  const VoxelSet all = soup_voxels(whole, soup);
  ASSERT_GT(all.size(), selected.size());
  EXPECT_EQ(compare(grid, soup, all).extra, all.size() - selected.size());
}

TEST(Compare, ThreadsDoNotChangeTheResult) {
  const Grid grid = test_grid(8);
  const auto soup = random_soup(grid, 9000, 8, 3);
  const VoxelSet expected = soup_voxels(grid, soup);
  VoxelSet voxels;
  for (const auto& [x, y, z] : expected) {
    if ((x + y + z) % 5 != 0) voxels.emplace(x, y, z);
  }
  const Comparison one = compare(grid, soup, voxels, 1), three = compare(grid, soup, voxels, 3);
  EXPECT_EQ(one.missing, expected.size() - voxels.size());
  EXPECT_EQ(one.missing, three.missing);
  EXPECT_EQ(one.wrong_bricks, three.wrong_bricks);
  ASSERT_EQ(one.first.size(), three.first.size());
  for (size_t i = 0; i < one.first.size(); ++i) EXPECT_EQ(one.first[i].voxel, three.first[i].voxel);
}

}  // namespace
}  // namespace svdag
