// A spot of the stress suite: an octree cube at which the descent starts, and a small region of
// voxels in it that is compared.
//
// The descent starts at each level 0 .. L-2. A cube with a million voxels a side has too many
// voxels to compare, so a deep descent is restricted to the region by the grid's selection
// (--bounds): the triangle list is divided at every level from the start down, exactly as in a
// whole bake, and only the subtrees beside the path are left out. If the triangles are small, the
// whole cube is voxelized and the region compared.
#pragma once

#include "builder/descend/voxelize_window.h"
#include "tests/stress/random.h"
#include "tests/stress/voxel_region.h"

namespace svdag {

struct Spot {
  Grid grid;
  Cube start;
  VoxelBox region;  // inside `start`

  int64_t voxel() const { return int64_t(1) << grid.fraction(); }  // in lattice steps
  // A lattice point of the closed region.
  LatticePoint anchor(StressRandom* random) const {
    LatticePoint p;
    for (int a = 0; a < 3; ++a)
      p[a] = random->between(region.min[a] << grid.fraction(), region.max[a] << grid.fraction());
    return p;
  }
  // A corner of a voxel of the closed region.
  LatticePoint corner(StressRandom* random) const {
    LatticePoint p;
    for (int a = 0; a < 3; ++a)
      p[a] = random->between(region.min[a], region.max[a]) << grid.fraction();
    return p;
  }
};

// The area of the grid from which a spot is drawn.
enum class SpotArea { kAnywhere, kBorder, kMiddle };

// A spot whose descent starts at `depth`; the region is a cube of at most `side` voxels.
Spot draw_spot(const Grid& grid, int depth, int64_t side, SpotArea area, StressRandom* random);

// A grid whose world coordinates are voxel coordinates: voxel size 1, corner at zero.
Grid unit_grid(int levels);

}  // namespace svdag
