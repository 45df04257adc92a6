// The voxel window that formats of single voxels write: a box of one level of a DAG.
#pragma once

#include <bit>

#include "io/dag/walk/cube_walk.h"
#include "io/formats/voxel_colours.h"
#include "io/voxel_source.h"
#include "streaming/process/interrupt.h"

namespace svdag {

struct VoxelWindow {
  Grid grid;                              // of the level; its selection is the window
  CubeWalk* walk;                         // of the level
  uint64_t voxels;                        // number set in the window
  const LayerLabels* labels = nullptr;    // null: the file has no layers
  const VoxelColours* colours = nullptr;  // null: it has no colours either

  const VoxelBox& box() const { return grid.selection; }
};

// Calls visit(voxel) for each set voxel of a cube.
template <class Visit>
void for_each_voxel(const VoxelCube& cube, const Visit& visit) {
  const LatticePoint& from = cube.origin;
  if (cube.side != kBlockSide) {
    for (int64_t x = 0; x < cube.side; ++x)
      for (int64_t y = 0; y < cube.side; ++y)
        for (int64_t z = 0; z < cube.side; ++z)
          visit(Voxel{uint32_t(from.x + x), uint32_t(from.y + y), uint32_t(from.z + z)});
    return;
  }
  for (unsigned x = 0; x < 8; ++x) {
    for (uint64_t plane = cube.block.words[x]; plane != 0; plane &= plane - 1) {
      const unsigned yz = unsigned(std::countr_zero(plane));
      visit(Voxel{uint32_t(from.x) + x, uint32_t(from.y) + (yz >> 3), uint32_t(from.z) + (yz & 7)});
    }
  }
}

// The same for a box, cube by cube. Returns the number of its voxels.
template <class Visit>
uint64_t for_each_voxel(CubeWalk* walk, const VoxelBox& box, const Visit& visit) {
  uint64_t visited = 0;
  walk->visit(box, [&](const VoxelCube& cube) {
    check_interrupt();
    visited += cube.count();
    for_each_voxel(cube, visit);
    return true;
  });
  return visited;
}

}  // namespace svdag
