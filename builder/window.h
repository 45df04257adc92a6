// The voxelizer asked directly: a window (a cube of the octree) and triangles in, bricks out.
//
// Tests judge this interface and not a predicate, so that every kernel, filter and memo of the
// descent stands under the same suites.
#pragma once

#include <functional>
#include <span>

#include "builder/descend.h"

namespace svdag {

// A brick at `coordinate`, in units of bricks from the grid's corner.
using BrickSink = std::function<void(const LatticePoint& coordinate, Brick brick)>;

// All bricks with a voxel in `window` that `triangles` set, in Morton order; returns
// the number of voxels. `grid.levels` bounds the window's level at grid.levels - 2.
uint64_t voxelize_window(const Grid& grid, const DescentConfig& config, const Cube& window,
                         std::span<const LatticeTriangle> triangles, const BrickSink& sink,
                         MemoryBudget* budget = nullptr);

}  // namespace svdag
