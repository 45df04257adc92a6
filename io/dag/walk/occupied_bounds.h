// The box of the set voxels of a DAG.
//
// Each of the six sides is found by a descent that enters only the half of a node that is nearer to
// that side, unless this half is empty. The result of a node is computed once. So the cost depends
// on the nodes at the surface of the box, not on the number of voxels.
#pragma once

#include "io/dag/dag_view.h"
#include "io/grid.h"

namespace svdag {

// The smallest box that holds all set voxels, in voxels; empty if none is set.
VoxelBox occupied_bounds(const DagView& dag);

// The same box in world units: from the corner of its first voxel to the end of its last.
Box world_box(const Grid& grid, const VoxelBox& voxels);

}  // namespace svdag
