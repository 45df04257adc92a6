// The hole test: whether the voxels of a closed surface separate its inside from its outside.
//
// Kong and Rosenfeld, "Digital Topology" (1989): a set of voxels is N-separating if no path of
// N-neighbours through its complement leads from one side to the other. Every step of such a path
// is a pair of neighbouring empty voxels, so a leak is a pair of empty neighbours whose centres are
// on different sides. The test is local, needs no flood fill, and works in windows that the surface
// crosses many times. Sides are exact: the parity of the crossings of a centre line with the whole
// snapped mesh, with the ties of the thin rule (tests/stress/centre_lines.h). Conservative voxels
// must be 26-separating, thin ones 6-separating.
//
// Rejected: a flood fill from one corner of the window. It misses pockets, and where the surface
// leaves the window it reports the path around it as a leak.
#pragma once

#include <span>

#include "io/dag/format.h"
#include "tests/stress/test_spot.h"

namespace svdag {

struct Separation {
  uint64_t tested = 0;   // empty voxels whose neighbours were tested
  uint64_t leaks = 0;    // of these: inside, with an empty neighbour outside
  uint64_t crossed = 0;  // windows with empty voxels on both sides
  uint64_t windows = 0;

  Separation& operator+=(const Separation& other);
};

// Whether every edge of the snapped mesh is used an even number of times, so that sides exist.
bool is_closed(std::span<const LatticeTriangle> mesh);

// The voxels of `box` whose centres are inside the closed `mesh`.
VoxelRegion inside_of(std::span<const LatticeTriangle> mesh, const VoxelBox& box, int shift);

// Counts leaks among the voxels of one window: `set` by the voxelizer, `inside` of the mesh.
Separation count_leaks(const VoxelRegion& set, const VoxelRegion& inside, Rule rule);

}  // namespace svdag
