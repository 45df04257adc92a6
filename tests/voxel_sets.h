// Sets of voxels with bodies in them: what surfaces lack, full cubes of every size.
#pragma once

#include <random>

#include "io/dag/walk/voxel_cube.h"
#include "tests/verify/raw_dag.h"

namespace svdag {

inline void add_box(VoxelSet* set, const VoxelBox& box) {
  LatticePoint at;
  for (at.x = box.min.x; at.x < box.max.x; ++at.x)
    for (at.y = box.min.y; at.y < box.max.y; ++at.y)
      for (at.z = box.min.z; at.z < box.max.z; ++at.z) set->emplace(at.x, at.y, at.z);
}

// Single voxels and boxes, some of them aligned cubes of 8, 16 and 32 voxels.
inline VoxelSet bodies(int levels, uint64_t seed) {
  std::mt19937_64 random(seed);
  const int64_t side = int64_t(1) << levels;
  const auto below = [&](int64_t n) { return int64_t(random() % uint64_t(n)); };
  VoxelSet set;
  for (int i = 0; i < 60; ++i) set.emplace(below(side), below(side), below(side));
  for (int i = 0; i < 6; ++i) {
    const int64_t step = std::min<int64_t>(side, int64_t(8) << below(3));
    LatticePoint corner;
    for (int a = 0; a < 3; ++a) corner[a] = below(side / step) * step;
    add_box(&set, {corner, corner + step});
  }
  const LatticePoint corner(below(side - 5), below(side - 5), below(side - 5));
  add_box(&set, {corner, corner + int64_t(5)});
  return set;
}

// The voxels of a cube, each once.
inline void add_cube(VoxelSet* set, const VoxelCube& cube) {
  if (cube.side != kBlockSide) return add_box(set, cube.box());
  for (unsigned i = 0; i < 512; ++i)
    if (cube.block.get(i >> 6, i >> 3 & 7, i & 7))
      set->emplace(cube.origin.x + (i >> 6), cube.origin.y + (i >> 3 & 7), cube.origin.z + (i & 7));
}

inline bool holds(const VoxelBox& box, const LatticePoint& v) {
  for (int a = 0; a < 3; ++a)
    if (v[a] < box.min[a] || v[a] >= box.max[a]) return false;
  return true;
}

}  // namespace svdag
