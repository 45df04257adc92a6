// Triangle soups on the lattice of a test grid, and the file that is right for them.
#pragma once

#include <random>
#include <vector>

#include "tests/verify/raw_dag.h"

namespace svdag {

inline std::vector<LatticeTriangle> random_soup(const Grid& grid, int count, uint64_t seed,
                                                int64_t largest_side_in_voxels) {
  std::mt19937_64 random(seed);
  const auto below = [&](int64_t n) { return int64_t(random() % uint64_t(n)); };
  const int64_t side = int64_t(1) << grid.fraction();
  const int64_t reach = 1 + below(largest_side_in_voxels) * side;
  std::vector<LatticeTriangle> soup(static_cast<size_t>(count));
  for (LatticeTriangle& t : soup) {
    for (int a = 0; a < 3; ++a) {
      const int64_t corner = below(grid.resolution() * side);
      for (LatticePoint& p : t.v) p[a] = corner + below(2 * reach + 1) - reach;
    }
    // Some vertices on voxel planes; some triangles reach out of the grid.
    if (random() % 3 == 0) t.v[1] = (t.v[1] / side) * side;
  }
  return soup;
}

// The voxels that the soup sets, each triangle clipped as a whole, without tiles.
inline VoxelSet soup_voxels(const Grid& grid, const std::vector<LatticeTriangle>& soup) {
  VoxelSet voxels;
  for (const LatticeTriangle& t : soup)
    voxels.merge(clipped_voxels(t, grid.fraction(), grid.selection));
  return voxels;
}

}  // namespace svdag
