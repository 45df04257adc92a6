// Conversion from voxels to world coordinates, for families that draw doubles.
#pragma once

#include "io/lattice.h"
#include "tests/stress/family.h"

namespace svdag {

// The world position of a point given in voxels from the grid's corner, rounded by double.
inline Point to_world(const Grid& grid, const Point& voxels) {
  Point p;
  for (int a = 0; a < 3; ++a) {
    p[a] = grid.kind == Grid::Kind::kBox ? grid.origin[a] + voxels[a] * grid.voxel_size
                                         : (voxels[a] + double(grid.k0[a]) + 0.5) * grid.voxel_size;
  }
  return p;
}

// A point of the region, in voxels from the grid's corner.
inline Point anchor_in_voxels(const Spot& spot, StressRandom* random) {
  return Point(spot.anchor(random)) / double(spot.voxel());
}

inline Soup snapped(const Grid& grid, const std::vector<Triangle>& triangles) {
  const Lattice lattice(grid);
  Soup soup(triangles.size());
  for (size_t i = 0; i < soup.size(); ++i) {
    for (int j = 0; j < 3; ++j) soup[i].v[j] = lattice.snap(triangles[i].v[j]);
  }
  return soup;
}

}  // namespace svdag
