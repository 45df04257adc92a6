// Clusters of differences against the voxels that differ.
#include "verify/compare/dag_diff.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/voxel_sets.h"

namespace svdag {
namespace {

std::vector<DiffCluster> clusters_of(int levels, const VoxelSet& a, const VoxelSet& b) {
  const Grid grid = test_grid(levels);
  const RawFile file_a(raw_dag(grid, a)), file_b(raw_dag(grid, b));
  DagDiff diff(file_a.view(), file_b.view());
  diff.count();
  return diff_clusters(&diff);
}

TEST(DiffClusters, TouchingCellsAreOneClusterAndOthersAreNot) {
  const int levels = 9;  // cells of 8 voxels
  VoxelSet a, b;
  add_box(&a, {{100, 100, 100}, {120, 102, 102}});  // cells 12 .. 14 along x
  a.emplace(400, 400, 400);
  b.emplace(408, 408, 408);  // the cell across the corner
  b.emplace(0, 0, 511);
  const auto clusters = clusters_of(levels, a, b);
  ASSERT_EQ(clusters.size(), 3U);
  EXPECT_EQ(clusters[0].only_a, 80U);
  EXPECT_EQ(clusters[0].only_b, 0U);
  EXPECT_EQ(clusters[0].box, (VoxelBox{{96, 96, 96}, {120, 104, 104}}));
  EXPECT_EQ(clusters[1].only_a, 1U);
  EXPECT_EQ(clusters[1].only_b, 1U);
  EXPECT_EQ(clusters[1].box, (VoxelBox{{400, 400, 400}, {416, 416, 416}}));
  EXPECT_EQ(clusters[2].box, (VoxelBox{{0, 0, 504}, {8, 8, 512}}));
}

TEST(DiffClusters, HoldEveryDifferingVoxelOnce) {
  for (int levels = 3; levels <= 8; ++levels) {
    const VoxelSet a = bodies(levels, 2), b = bodies(levels, 3);
    uint64_t only_a = 0, only_b = 0, counted_a = 0, counted_b = 0;
    const auto clusters = clusters_of(levels, a, b);
    const auto covered = [&](const VoxelSet::value_type& v) {
      const LatticePoint at(std::get<0>(v), std::get<1>(v), std::get<2>(v));
      return std::any_of(clusters.begin(), clusters.end(), [&](const DiffCluster& cluster) {
        return cluster.box.holds({at, at + int64_t(1)});
      });
    };
    for (const auto& v : a) {
      if (b.contains(v)) continue;
      ++only_a;
      EXPECT_TRUE(covered(v));
    }
    for (const auto& v : b) {
      if (a.contains(v)) continue;
      ++only_b;
      EXPECT_TRUE(covered(v));
    }
    for (const DiffCluster& cluster : clusters) {
      counted_a += cluster.only_a;
      counted_b += cluster.only_b;
    }
    EXPECT_EQ(counted_a, only_a) << levels;
    EXPECT_EQ(counted_b, only_b) << levels;
  }
}

TEST(DiffClusters, EqualDagsHaveNone) {
  const VoxelSet a = bodies(6, 4);
  EXPECT_TRUE(clusters_of(6, a, a).empty());
}

}  // namespace
}  // namespace svdag
