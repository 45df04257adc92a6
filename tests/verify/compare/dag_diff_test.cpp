// Tests that the difference of two DAGs is the difference of their voxel sets, at the coarser
// resolution.
#include "verify/compare/dag_diff.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "io/brick.h"
#include "tests/verify/soup.h"

namespace svdag {
namespace {

VoxelSet coarsened(const VoxelSet& voxels, int by) {
  VoxelSet result;
  for (const auto& [x, y, z] : voxels) result.insert({x >> by, y >> by, z >> by});
  return result;
}

void expect_difference(const Grid& grid_a, const VoxelSet& a, const Grid& grid_b,
                       const VoxelSet& b) {
  const RawFile file_a(raw_dag(grid_a, a)), file_b(raw_dag(grid_b, b));
  const int levels = std::min(grid_a.levels, grid_b.levels);
  const VoxelSet in_a = coarsened(a, grid_a.levels - levels);
  const VoxelSet in_b = coarsened(b, grid_b.levels - levels);
  VoxelSet only_a, only_b;
  std::set_difference(in_a.begin(), in_a.end(), in_b.begin(), in_b.end(),
                      std::inserter(only_a, only_a.end()));
  std::set_difference(in_b.begin(), in_b.end(), in_a.begin(), in_a.end(),
                      std::inserter(only_b, only_b.end()));
  DagDiff diff(file_a.view(), file_b.view());
  EXPECT_EQ(diff.levels(), uint32_t(levels));
  const DiffCounts counts = diff.count();
  EXPECT_EQ(counts.only_a, only_a.size());
  EXPECT_EQ(counts.only_b, only_b.size());
  EXPECT_EQ(counts.both, in_a.size() - only_a.size());
  EXPECT_EQ(counts.same(), in_a == in_b);
  VoxelSet seen_a, seen_b;
  diff.visit([&](const std::array<uint32_t, 3>& at, uint64_t brick_a, uint64_t brick_b) {
    for (unsigned bit = 0; bit < 64; ++bit) {
      const auto [x, y, z] = brick_voxel(bit);
      const VoxelSet::value_type voxel{4 * at[0] + x, 4 * at[1] + y, 4 * at[2] + z};
      if (brick_a & ~brick_b & uint64_t(1) << bit) seen_a.insert(voxel);
      if (brick_b & ~brick_a & uint64_t(1) << bit) seen_b.insert(voxel);
    }
    return true;
  });
  EXPECT_EQ(seen_a, only_a);
  EXPECT_EQ(seen_b, only_b);
}

TEST(DagDiff, CountsAndListsTheVoxelsOfOnlyOne) {
  for (int levels = 3; levels <= 8; ++levels) {
    const Grid grid = test_grid(levels);
    const VoxelSet a = soup_voxels(grid, random_soup(grid, 40, uint64_t(levels), 20));
    VoxelSet b = a;
    for (int i = 0; i < 5; ++i) b.erase(std::next(b.begin(), ptrdiff_t(b.size() / 2)));
    b.insert({1, 2, 3});
    expect_difference(grid, a, grid, b);
    expect_difference(grid, a, grid, a);
    expect_difference(grid, a, grid, {});
    expect_difference(grid, {}, grid, {});
    expect_difference(grid, a, grid, soup_voxels(grid, random_soup(grid, 40, 99, 20)));
  }
}

TEST(DagDiff, ComparesDifferentResolutionsAtTheCoarser) {
  for (int levels = 3; levels <= 6; ++levels) {
    for (int finer = 1; finer <= 4; ++finer) {
      const Grid grid = test_grid(levels), fine_grid = test_grid(levels + finer);
      const VoxelSet fine = soup_voxels(fine_grid, random_soup(fine_grid, 30, 7, 30));
      expect_difference(fine_grid, fine, grid, coarsened(fine, finer));
      VoxelSet coarse = coarsened(fine, finer);
      coarse.erase(coarse.begin());
      coarse.insert({0, 0, 0});
      expect_difference(grid, coarse, fine_grid, fine);
    }
  }
}

TEST(DagDiff, StopsWhenTheSinkReturnsFalse) {
  const Grid grid = test_grid(6);
  const VoxelSet a = soup_voxels(grid, random_soup(grid, 40, 1, 20));
  const RawFile file_a(raw_dag(grid, a)), file_b(raw_dag(grid, {}));
  DagDiff diff(file_a.view(), file_b.view());
  diff.count();
  int visits = 0;
  diff.visit([&](const auto&, uint64_t, uint64_t) { return ++visits < 3; });
  EXPECT_EQ(visits, 3);
}

TEST(Brick, VoxelIsTheInverseOfBit) {
  for (unsigned bit = 0; bit < 64; ++bit) {
    const auto [x, y, z] = brick_voxel(bit);
    EXPECT_EQ(brick_bit(x, y, z), bit);
  }
}

}  // namespace
}  // namespace svdag
