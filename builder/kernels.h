// The two inner loops of the descent, for the widest vectors that the processor has.
//
// A kernel takes a whole list, so that the choice of the processor costs one indirect call per cube
// and not per triangle. Vectors hold the 8 children of a cube or rows of the 64 voxels of a brick:
// lanes are places, triangles come one after the other. Rejected: lanes as triangles (lists are
// short near the bricks, and each triangle has other edges undecided).
//
// Same bits on every machine: a child may be reported touched though it is not (the safe side), but
// every target computes the same doubles in the same order, without fused multiply-add; a voxel is
// exact whatever computed it. The plain kernels (builder/overlap.h) are the reference.
#pragma once

#include <cstddef>
#include <vector>

#include "builder/overlap.h"

namespace svdag {

struct Kernels {
  // out[i] of `count` entries: the children of the cube at `corner` with side `side` (lattice
  // units, a power of two) that the triangle may touch.
  using Children = void (*)(const Entry* entries, size_t count, const LatticePoint& corner,
                            int64_t side, ChildOverlap* out) noexcept;
  // The voxels of `wanted` that one of the entries sets, in the brick at `corner`.
  using Voxels = Brick (*)(const Entry* entries, size_t count, const LatticePoint& corner,
                           int fraction, Brick wanted, DecisionCounts* counts) noexcept;

  const char* name;  // of the instruction set
  int lanes;         // doubles in a vector
  Children children;
  Voxels conservative;
  Voxels thin;
};

// One triangle after the other, by builder/overlap.h.
const Kernels& plain_kernels();
// The best of this processor.
const Kernels& kernels();
// Every vector width that was compiled and that this processor has, best first.
std::vector<Kernels> vector_kernels();

}  // namespace svdag
