// A level of a DAG as a coarser grid.
//
// A voxel of level K is a cube of side 2^(L-K) voxels. It is set iff it contains a set voxel, that
// is, iff level K has a node there. So the file contains every coarser grid: its bricks are
// computed from the nodes of level K-2 and their children, without building or storing anything.
#pragma once

#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

// The 4^3 subcubes of the node (or brick) `index` of `level` <= L-2 as a brick: a bit is set where
// the subcube contains a set voxel.
uint64_t dag_brick_at(const DagView& dag, uint32_t level, uint32_t index);

// The grid of the voxels of level `levels` (3 .. L) of `grid`, with all voxels selected.
Grid level_grid(const Grid& grid, int levels);

}  // namespace svdag
