// Clusters of differences: where two DAGs differ, in a few boxes instead of millions of voxels.
//
// The grid is divided into 64^3 cells (of at least one brick). Cells that hold a difference and
// touch, by a face, edge or corner, are one cluster. So a cluster's box is exact to a cell.
// Rejected: clusters of single voxels, which take memory for each of them.
#pragma once

#include <vector>

#include "io/grid.h"
#include "verify/compare/diff.h"

namespace svdag {

struct DiffCluster {
  VoxelBox box;  // of its cells, in voxels of the comparison
  uint64_t only_a = 0, only_b = 0;
};

// After diff->count(). The clusters with most differing voxels first; equal ones in Morton order.
std::vector<DiffCluster> diff_clusters(DagDiff* diff);

}  // namespace svdag
