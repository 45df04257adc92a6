// The distances of voxel centres from triangles, computed by OpenVDB's mesh-to-volume conversion.
//
// tools::meshToVolume floods outward from every triangle as long as the squared distance of a
// voxel's centre is at most 3/4, so each voxel that a triangle may touch gets the distance to its
// nearest triangle, and so do their neighbours. It computes in double (our adapter passes doubles;
// the usual one passes floats) and keeps the square as a float, whose root it takes in float: a
// distance d is accurate to 2^-23 d. The point it measures to is on the triangle, so a distance is
// never too small; on needles, where its barycentric coordinates cancel, it may be too large.
#pragma once

#include <functional>
#include <span>

#include "io/triangle.h"

namespace svdag {

// A block of 8^3 distances, index 64x + 8y + z; distances above about one voxel are kFar.
constexpr float kFar = 3.4e38F;
using DistanceSink = std::function<void(const LatticePoint& origin, std::span<const float, 512>)>;

// `triangles` in voxels, voxel centres on the integers. Passes every block with a near voxel to the
// sink; their origins are multiples of 8. In a build without OpenVDB this is an Error (kUsage).
void vdb_distances(std::span<const Triangle> triangles, size_t threads, const DistanceSink& sink);

}  // namespace svdag
