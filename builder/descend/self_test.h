// The self-test of the voxelizer, run at the start of every bake.
//
// Triangles of every kind (small, large, beyond the grid, wider than 2^41 steps, with corners and
// edges on the planes and centres of voxels) are voxelized by the kernels that the bake will use,
// and the voxels are compared with a stored hash: 10^5 decisions in one or two milliseconds. This
// detects a processor, a compiler or an instruction translator that computes wrong results before a
// file is written. The tests establish that the hash is right.
// Rejected: comparing with the plain kernels (the same wrong arithmetic would agree with itself).
#pragma once

#include "builder/descend/descend.h"

namespace svdag {

// Returns the number of voxels compared (64 per non-empty brick). Error (kInternal) if the rule and
// kernels of `config` give wrong voxels.
uint64_t self_test(const DescentConfig& config);

}  // namespace svdag
