// Lines through the centres of voxels, and where a triangle crosses them: exact, ties included.
//
// A line of axis w runs through the centres of a column of voxels. All lines, centres and planes
// are moved by d = (e, e^2, e^3), e > 0 as small as needed (Edelsbrunner and Muecke, "Simulation of
// Simplicity", 1990), so a line is never met by an edge or a vertex and a crossing never coincides
// with a centre or a plane. Two questions are answered with it:
//   thin   rule thin: a voxel is set iff a triangle crosses one of its three centre segments;
//   side   on which side of a closed mesh a voxel's centre is: parity of crossings above it.
//
// How: the crossing's coordinate along w is a rational number; its floor and whether it is an
// integer are found by one exact division (verify/judge/exact.h), then ties go by the sign that d
// gives. The builder uses signs of the plane at the ends of segments instead: the two share no
// formula.
#pragma once

#include "tests/stress/voxel_region.h"

namespace svdag {

// Adds the voxels of `region` that rule thin sets for `triangle`; `shift` = log2 of a voxel's side.
void add_thin_voxels(const LatticeTriangle& triangle, int shift, VoxelRegion* region);

// Flips every voxel of `region` whose centre has `triangle` above it along z. After all triangles
// of a closed mesh, the voxels set are those whose centre is inside.
void flip_below(const LatticeTriangle& triangle, int shift, VoxelRegion* region);

}  // namespace svdag
