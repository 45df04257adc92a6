// The voxels of a window that a definition sets, tested one by one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <tuple>

#include "io/grid.h"
#include "io/triangle.h"

namespace svdag {

using VoxelSet = std::set<std::tuple<int64_t, int64_t, int64_t>>;

// Those of which `sets(voxel)` is true; a voxel of 2^shift lattice steps a side that the triangle's
// box cannot reach, by a generous margin, are not tested.
template <class Predicate>
VoxelSet voxels_where(const LatticeTriangle& t, int shift, const VoxelBox& window,
                      const Predicate& sets) {
  VoxelSet voxels;
  LatticePoint low = window.min, high = window.max;
  for (int a = 0; a < 3; ++a) {
    const auto [min, max] = std::minmax({t.v[0][a], t.v[1][a], t.v[2][a]});
    low[a] = std::max(low[a], (min >> shift) - 1);
    high[a] = std::min(high[a], (max >> shift) + 2);
  }
  for (int64_t x = low.x; x < high.x; ++x) {
    for (int64_t y = low.y; y < high.y; ++y) {
      for (int64_t z = low.z; z < high.z; ++z) {
        if (sets(LatticePoint(x, y, z))) voxels.emplace(x, y, z);
      }
    }
  }
  return voxels;
}

}  // namespace svdag
