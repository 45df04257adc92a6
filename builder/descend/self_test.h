// A question with a known answer, put to the voxelizer before it is believed.
//
// Some triangles of every kind (small, large, beyond the grid, wider than 2^41 steps, with corners
// and edges on the planes and centres of voxels) are voxelized by the very kernels that the bake
// will use, and the voxels compared with a hash of the right ones: 10^5 decisions, a millisecond or
// two. It tells a processor, a compiler or a translator of instructions that computes something
// else, before a file is written; what is right is for the tests to say.
// Rejected: the plain kernels as judge (the same wrong arithmetic would agree with itself).
#pragma once

#include "builder/descend/descend.h"

namespace svdag {

// Returns how many voxels of bricks that have one were decided. Error (kInternal) if rule and
// kernels of `config` give other voxels than they must.
uint64_t self_test(const DescentConfig& config);

}  // namespace svdag
