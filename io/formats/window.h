// The voxel window that formats of single voxels write: a box of one level of a DAG.
#pragma once

#include <bit>

#include "io/dag/cube_walk.h"
#include "io/formats/layer_labels.h"
#include "io/voxel_source.h"
#include "streaming/process/interrupt.h"

namespace svdag {

struct VoxelWindow {
  Grid grid;                            // of the level; its selection is the window
  CubeWalk* walk;                       // of the level
  uint64_t voxels;                      // number set in the window
  const LayerLabels* labels = nullptr;  // null: the file has no layers

  const VoxelBox& box() const { return grid.selection; }
};

// Calls visit(voxel) for each set voxel of a box, cube by cube. Returns their number.
template <class Visit>
uint64_t for_each_voxel(CubeWalk* walk, const VoxelBox& box, const Visit& visit) {
  const auto visit_box = [&](const LatticePoint& from, int64_t side, const auto& inside) {
    for (int64_t x = 0; x < side; ++x)
      for (int64_t y = 0; y < side; ++y)
        for (int64_t z = 0; z < side; ++z) {
          if (inside(x, y, z))
            visit(Voxel{uint32_t(from.x + x), uint32_t(from.y + y), uint32_t(from.z + z)});
        }
  };
  uint64_t visited = 0;
  walk->visit(box, [&](const VoxelCube& cube) {
    check_interrupt();
    if (cube.side != kBlockSide) {
      visited += uint64_t(cube.side * cube.side * cube.side);
      visit_box(cube.origin, cube.side, [](int64_t, int64_t, int64_t) { return true; });
      return true;
    }
    for (unsigned x = 0; x < 8; ++x) {
      visited += uint64_t(std::popcount(cube.block.words[x]));
      for (uint64_t plane = cube.block.words[x]; plane != 0; plane &= plane - 1) {
        const unsigned yz = unsigned(std::countr_zero(plane));
        visit(Voxel{uint32_t(cube.origin.x) + x, uint32_t(cube.origin.y) + (yz >> 3),
                    uint32_t(cube.origin.z) + (yz & 7)});
      }
    }
    return true;
  });
  return visited;
}

}  // namespace svdag
