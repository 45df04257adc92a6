// The normal of a surface that is known by its voxels only.
//
// Idea: Hoppe et al. 1992. The set voxels near a hit are samples of the surface; the direction in
// which their covariance is smallest is its normal. Where the voxels form no sheet (a wire, a
// single voxel) the face that the ray entered serves.
#pragma once

#include "verify/trace/vector.h"

namespace svdag {

// Unit normal at the hit voxel, turned towards where the ray came from.
Vec3 surface_normal(const DagView& dag, const Hit& hit, const Vec3& direction);

}  // namespace svdag
