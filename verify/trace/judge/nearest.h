// Finds the set voxel nearest to a point.
//
// Branch and bound (Roussopoulos et al. 1995): a node is skipped if the box of its voxels' centres
// is further away than the best voxel so far. Children are visited from the point's own octant
// outwards, so a good candidate is found early.
#pragma once

#include "verify/trace/kernel/traverse.h"

namespace svdag {

struct NearestVoxel {
  bool found = false;   // false: no centre is within the requested distance
  double distance = 0;  // from the point to the voxel's centre, in voxels
  uint32_t voxel[3] = {};
};

// The voxel whose centre is nearest to `point` and nearer than `within`.
NearestVoxel nearest_voxel(const DagView& dag, const Vec3& point, double within);

}  // namespace svdag
