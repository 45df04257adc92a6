// Direct access to the voxelizer: a window (a cube of the octree) and triangles in, bricks out.
//
// Bakes dense cubes (builder/descend/dense_cube.h). Tests judge it rather than a single predicate,
// so the same suites cover every kernel, filter and memo of the descent.
#pragma once

#include <functional>
#include <span>

#include "builder/descend/descend.h"

namespace svdag {

// A brick at `coordinate`, in units of bricks from the grid's corner.
using BrickSink = std::function<void(const LatticePoint& coordinate, Brick brick)>;

// All bricks with a voxel in `window` that `triangles` set, in Morton order; returns
// the number of voxels. `grid.levels` bounds the window's level at grid.levels - 2.
uint64_t voxelize_window(const Grid& grid, const DescentConfig& config, const Cube& window,
                         std::span<const LatticeTriangle> triangles, const BrickSink& sink,
                         MemoryBudget* budget = nullptr);

}  // namespace svdag
