// Direct access to the voxelizer: a window (an octree cube) and triangles in, bricks out.
//
// Dense cubes (builder/descend/dense_cube.h) are baked by it. Tests use it instead of single
// predicates, so the same suites cover every kernel, filter and memo of the descent.
#pragma once

#include <functional>
#include <span>

#include "builder/descend/descend.h"

namespace svdag {

// A brick at `coordinate`, in units of bricks from the grid's corner.
using BrickSink = std::function<void(const LatticePoint& coordinate, Brick brick)>;

// Passes the non-empty bricks of `triangles` in `window` to `sink`, in Morton order; returns the
// number of voxels. window.level is at most grid.levels - 2. The solid rules need all triangles of
// the solid. `cuts`: the records of those that are cut.
uint64_t voxelize_window(const Grid& grid, const DescentConfig& config, const Cube& window,
                         std::span<const LatticeTriangle> triangles, const BrickSink& sink,
                         MemoryBudget* budget = nullptr, const CutRecords* cuts = nullptr);

}  // namespace svdag
