// Exact crossings of triangles with the centre lines of voxels, including ties.
//
// A line of axis w passes through the centres of a column of voxels. All lines, centres and planes
// are moved by d = (e, e^2, e^3), e > 0 as small as needed (Edelsbrunner and Muecke, "Simulation of
// Simplicity", 1990), so no edge or vertex meets a line, and no crossing coincides with a centre or
// a plane. Two tests use the crossings:
//   thin   the thin rule: a voxel is set iff a triangle crosses one of its three centre segments;
//   side   the side of a closed mesh on which a voxel's centre is: the parity of crossings above
//   it.
//
// Method: the crossing's coordinate along w is a rational number. One exact division
// (verify/judge/exact_quotients.h) gives its floor and whether it is an integer; ties are resolved
// by the sign that d gives. The builder computes signs of the plane at the ends of segments
// instead, so the two share no formula.
#pragma once

#include "tests/stress/voxel_region.h"

namespace svdag {

// Adds the voxels of `region` that the thin rule sets for `triangle`; `shift` = log2 of a voxel's
// side.
void add_thin_voxels(const LatticeTriangle& triangle, int shift, VoxelRegion* region);

// Flips every voxel of `region` whose centre has `triangle` above it along z. After all triangles
// of a closed mesh, exactly the voxels with their centre inside are set.
void flip_below(const LatticeTriangle& triangle, int shift, VoxelRegion* region);

}  // namespace svdag
