// A level of a DAG as a grid of its own.
//
// A voxel of level K is a cube of 2^(L-K) voxels a side; it is set iff a voxel in it is, that is,
// iff level K has a node there. So the file contains every coarser grid: its bricks are derived
// from the nodes of level K-2 and their children. Nothing is built or stored.
#pragma once

#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

// The brick of the node (or brick) `index` of level `level` <= levels - 2: 4^3 parts of the cube,
// set where a voxel is.
uint64_t dag_brick_at(const DagView& dag, uint32_t level, uint32_t index);

// The grid of the voxels of level `levels` (3 .. L) of `grid`, all of them selected.
Grid level_grid(const Grid& grid, int levels);

}  // namespace svdag
