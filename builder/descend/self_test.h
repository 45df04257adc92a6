// A self-test of the voxelizer with a known result, run before every bake.
//
// Some triangles of every kind (small, large, beyond the grid, wider than 2^41 steps, with corners
// and edges on the planes and centres of voxels) are voxelized by the kernels that the bake will
// use, and the voxels are compared with a stored hash: 10^5 decisions, a millisecond or two. It
// detects a processor, compiler or emulator that computes other results, before a file is written.
// The tests prove that the stored hash is right.
// Rejected: the plain kernels as judge (the same wrong arithmetic would agree with itself).
#pragma once

#include "builder/descend/descend.h"

namespace svdag {

// Returns how many voxels of bricks that have one were decided. Error (kInternal) if rule and
// kernels of `config` give other voxels than they must.
uint64_t self_test(const DescentConfig& config);

}  // namespace svdag
