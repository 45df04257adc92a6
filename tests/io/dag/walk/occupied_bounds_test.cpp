// Tests that the bounds of a DAG are those of its list of voxels.
#include "io/dag/walk/occupied_bounds.h"

#include <gtest/gtest.h>

#include "tests/voxel_sets.h"

namespace svdag {
namespace {

VoxelBox box_of(const VoxelSet& set) {
  VoxelBox box{LatticePoint(INT64_MAX), LatticePoint(INT64_MIN)};
  for (const auto& [x, y, z] : set) {
    const LatticePoint voxel(x, y, z);
    box.min = glm::min(box.min, voxel);
    box.max = glm::max(box.max, voxel + int64_t(1));
  }
  return box;
}

TEST(OccupiedBounds, AreThoseOfTheVoxels) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    const VoxelSet voxels = bodies(6, seed);
    const RawFile file{raw_dag(test_grid(6), voxels)};
    EXPECT_EQ(occupied_bounds(file.view()), box_of(voxels)) << seed;
  }
}

TEST(OccupiedBounds, OfOneVoxelAnywhere) {
  for (const LatticePoint& p : {LatticePoint(0), LatticePoint(63), LatticePoint(17, 0, 62)}) {
    VoxelSet one;
    one.emplace(p.x, p.y, p.z);
    const RawFile file{raw_dag(test_grid(6), one)};
    EXPECT_EQ(occupied_bounds(file.view()), (VoxelBox{p, p + int64_t(1)}));
  }
}

TEST(OccupiedBounds, OfNoVoxelAreEmpty) {
  const RawFile file{raw_dag(test_grid(6), {})};
  EXPECT_TRUE(occupied_bounds(file.view()).empty());
}

TEST(OccupiedBounds, InTheWorldEndAtTheEndOfTheLastVoxel) {
  Grid grid;
  grid.voxel_size = 0.5;
  grid.origin = Point(10, 20, 30);
  const Box box = world_box(grid, {LatticePoint(2, 0, 1), LatticePoint(3, 8, 2)});
  EXPECT_EQ(box.min, Point(11, 20, 30.5));
  EXPECT_EQ(box.max, Point(11.5, 24, 31));
}

}  // namespace
}  // namespace svdag
