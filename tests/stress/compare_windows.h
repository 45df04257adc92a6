// Compares the voxels of the voxelizer and of the judges, bit by bit.
//
// A decision is one voxel of a compared region that touches the surface, or has one among its 26
// neighbours in the region that does (by the conservative judge, for either rule): the voxels
// within one voxel of the surface, where errors occur. The other voxels of the region are compared
// too, but not counted.
#pragma once

#include <span>

#include "io/dag/format.h"
#include "tests/stress/test_spot.h"

namespace svdag {

struct Tally {
  uint64_t decisions = 0;
  uint64_t misses = 0;  // set by the judge only
  uint64_t extras = 0;  // set by the voxelizer only, or outside of the selection

  Tally& operator+=(const Tally& other);
};

// The region as the voxelizer (builder/descend/voxelize_window.h) sets it. Adds to *outside, if
// given, the voxels that are set outside the region although only the region is selected.
VoxelRegion voxelized(const Spot& spot, const DescentConfig& config,
                      std::span<const LatticeTriangle> triangles, uint64_t* outside = nullptr);
// The region as the judge sets it: conservative by clipping (verify/judge/clip_judge.h), thin by
// the crossings of centre lines (tests/stress/centre_lines.h), solid by winding numbers
// (verify/judge/centre_lines.h).
VoxelRegion judged(const Spot& spot, Rule rule, std::span<const LatticeTriangle> triangles);

// Compares the voxelizer in its default configuration with the judge, and also one of its other
// paths (tests/stress/paths.h), each in turn.
Tally compare_window(const Spot& spot, Rule rule, std::span<const LatticeTriangle> triangles);

}  // namespace svdag
