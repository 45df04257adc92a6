// Exact comparison of the distance of a voxel's centre from a triangle with a bound.
//
// On the lattice the centre of voxel k is the integer point (2k + 1) * 2^(F-1). The squared
// distance of a point p from a triangle is (n.(p-a))^2 / n.n if p projects into it, else the
// smallest squared distance from an edge e = v-u: |p-u|^2 or |p-v|^2 beyond its ends,
// (|p-u|^2 |e|^2 - ((p-u).e)^2) / |e|^2 between them. All are quotients of integers, compared with
// a bound by multiplying out. Slow (about a microsecond) but without tolerance: for the few voxels
// that a float cannot decide.
#pragma once

#include "io/triangle.h"

namespace svdag {

// True if the squared distance of the centre of `voxel` from the closed triangle is at most
// quarters/4 voxels squared: 1 is the ball inside the voxel's cube, 3 the ball around it.
bool centre_within(const LatticeTriangle& triangle, const LatticePoint& voxel, int fraction,
                   int quarters);

}  // namespace svdag
