// Tests that blocks and full cubes are exactly the voxels of a box of a level.
#include "io/dag/walk/cube_walk.h"

#include <gtest/gtest.h>

#include "io/dag/dag_level.h"
#include "tests/voxel_sets.h"

namespace svdag {
namespace {

VoxelSet coarser(const VoxelSet& set, int levels) {
  VoxelSet result;
  for (const auto& [x, y, z] : set) result.emplace(x >> levels, y >> levels, z >> levels);
  return result;
}

VoxelSet inside(const VoxelSet& set, const VoxelBox& box) {
  VoxelSet result;
  for (const auto& [x, y, z] : set)
    if (holds(box, {x, y, z})) result.emplace(x, y, z);
  return result;
}

// The voxels of a walk, which must emit none twice.
VoxelSet walked(CubeWalk* walk, const VoxelBox& box, int64_t* largest = nullptr) {
  VoxelSet set;
  uint64_t count = 0;
  walk->visit(box, [&](const VoxelCube& cube) {
    add_cube(&set, cube);
    count += cube.count();
    if (largest != nullptr) *largest = std::max(*largest, cube.side);
    return true;
  });
  EXPECT_EQ(count, set.size());
  return set;
}

class CubeWalkOf : public ::testing::TestWithParam<int> {
 protected:
  const Grid grid_ = test_grid(6);
  const VoxelSet voxels_ = bodies(6, uint64_t(GetParam()));
  const RawFile file_{raw_dag(grid_, voxels_)};
};

TEST_P(CubeWalkOf, EveryLevelEmitsTheParentsOfTheVoxels) {
  for (int levels = 3; levels <= 6; ++levels) {
    CubeWalk walk(file_.view(), uint32_t(levels));
    const VoxelBox whole = level_grid(grid_, levels).whole();
    const VoxelSet expected = coarser(voxels_, 6 - levels);
    EXPECT_EQ(walked(&walk, whole), expected);
    EXPECT_EQ(walk.count_voxels(whole), expected.size());
  }
}

TEST_P(CubeWalkOf, ABoxIsCutAtVoxels) {
  std::mt19937_64 random(uint64_t(GetParam()) + 100);
  CubeWalk walk(file_.view(), 6);
  for (int i = 0; i < 40; ++i) {
    VoxelBox box;
    for (int a = 0; a < 3; ++a) {
      box.min[a] = int64_t(random() % 70) - 3;
      box.max[a] = box.min[a] + int64_t(random() % 60);
    }
    const VoxelSet expected = inside(voxels_, box);
    EXPECT_EQ(walked(&walk, box), expected);
    EXPECT_EQ(walk.count_voxels(box), expected.size());
  }
}

TEST_P(CubeWalkOf, ABlockMayBeAnywhere) {
  std::mt19937_64 random(uint64_t(GetParam()) + 200);
  CubeWalk walk(file_.view(), 6);
  for (int i = 0; i < 200; ++i) {
    VoxelCube cube;
    for (int a = 0; a < 3; ++a) cube.origin[a] = int64_t(random() % 80) - 8;
    cube.block = walk.block(cube.origin);
    VoxelSet set;
    add_cube(&set, cube);
    EXPECT_EQ(set, inside(voxels_, cube.box()));
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, CubeWalkOf, ::testing::Range(1, 6));

TEST(CubeWalk, FullCubesAreEmittedWhole) {
  VoxelSet voxels;
  add_box(&voxels, {{32, 0, 32}, {64, 32, 64}});
  voxels.emplace(1, 2, 3);
  const RawFile file(raw_dag(test_grid(6), voxels));
  CubeWalk walk(file.view(), 6);
  int64_t largest = 0;
  int cubes = 0;
  EXPECT_EQ(walked(&walk, test_grid(6).whole(), &largest), voxels);
  walk.visit(test_grid(6).whole(), [&](const VoxelCube&) { return ++cubes > 0; });
  EXPECT_EQ(largest, 32);
  EXPECT_EQ(cubes, 2);
}

TEST(CubeWalk, StopsWhenTheSinkReturnsFalse) {
  const RawFile file(raw_dag(test_grid(6), bodies(6, 9)));
  CubeWalk walk(file.view(), 6);
  int cubes = 0;
  EXPECT_FALSE(walk.visit(test_grid(6).whole(), [&](const VoxelCube&) { return ++cubes < 3; }));
  EXPECT_EQ(cubes, 3);
}

TEST(CubeWalk, CountsTheLeavesAndNodesOfAVdbTree) {
  const VoxelSet voxels{{0, 0, 0}, {1, 0, 0}, {8, 0, 0}, {128, 0, 0}, {255, 255, 255}};
  const RawFile file(raw_dag(test_grid(8), voxels));
  CubeWalk walk(file.view(), 8);
  const CubeCounts all = walk.count_cubes(test_grid(8).whole(), 100);
  EXPECT_EQ(all.blocks, 4U);
  EXPECT_EQ(all.middle, 3U);
  EXPECT_EQ(all.large, 1U);
  EXPECT_GT(walk.count_cubes(test_grid(8).whole(), 2).blocks, 2U);
}

TEST(CubeWalk, AnEmptyFileHasNoVoxels) {
  const RawFile file(raw_dag(test_grid(5), {}));
  CubeWalk walk(file.view(), 5);
  EXPECT_TRUE(walked(&walk, test_grid(5).whole()).empty());
  EXPECT_EQ(walk.count_voxels(test_grid(5).whole()), 0U);
  EXPECT_TRUE(walk.block({0, 0, 0}).empty());
}

TEST(LevelGrid, KeepsTheCornerAndDoublesTheVoxels) {
  const Grid grid = test_grid(6);
  const Grid coarse = level_grid(grid, 4);
  EXPECT_EQ(coarse.corner(), grid.corner());
  EXPECT_EQ(coarse.voxel_size, 4 * grid.voxel_size);
  EXPECT_EQ(coarse.selection, coarse.whole());
}

}  // namespace
}  // namespace svdag
