// Tests that a point query returns the voxel or the largest empty cube of the octree around it.
#include "io/dag/walk/cube_at.h"

#include <gtest/gtest.h>

#include "tests/voxel_sets.h"

namespace svdag {
namespace {

// Brute force: the number of set voxels in the cube of side 2^shift around `voxel`.
size_t voxels_around(const VoxelSet& set, const LatticePoint& voxel, int shift) {
  size_t count = 0;
  for (const auto& [x, y, z] : set)
    count += x >> shift == voxel.x >> shift && y >> shift == voxel.y >> shift &&
             z >> shift == voxel.z >> shift;
  return count;
}

TEST(CubeAt, IsTheVoxelOrTheLargestEmptyCube) {
  constexpr int kLevels = 5;
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const VoxelSet set = bodies(kLevels, seed);
    const RawFile file{raw_dag(test_grid(kLevels), set)};
    for (int64_t x = 0; x < 32; x += 3) {
      for (int64_t y = 0; y < 32; ++y) {
        for (int64_t z = 0; z < 32; z += 5) {
          const LatticePoint voxel(x, y, z);
          const CubeAt cube = cube_at(file.view(), voxel);
          const int shift = kLevels - cube.level;
          ASSERT_EQ(cube.set, set.count({x, y, z}) != 0);
          ASSERT_EQ(cube.min >> int64_t(shift), voxel >> int64_t(shift));
          if (cube.set) {
            ASSERT_EQ(cube.level, kLevels);
          } else {
            ASSERT_EQ(voxels_around(set, voxel, shift), 0U);
            ASSERT_TRUE(cube.level == 0 || voxels_around(set, voxel, shift + 1) > 0);
          }
        }
      }
    }
  }
}

TEST(CubeAt, InAnEmptyGridIsTheGrid) {
  const RawFile file{raw_dag(test_grid(5), {})};
  EXPECT_EQ(cube_at(file.view(), LatticePoint(7)).level, 0);
}

}  // namespace
}  // namespace svdag
