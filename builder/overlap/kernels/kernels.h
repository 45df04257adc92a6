// The inner loops of the descent, for the widest vectors that the processor has.
//
// A kernel takes a whole list, so that the choice of the processor costs one indirect call per cube
// and not per triangle. Vectors hold the 8 children of a cube or rows of the 64 voxels of a brick:
// lanes are places, triangles come one after the other. Rejected: lanes as triangles (lists are
// short near the bricks, and each triangle has other edges undecided).
//
// Same bits on every machine: a child may be reported touched though it is not (the safe side), but
// every target computes the same numbers in the same order, without fused multiply-add; a voxel is
// exact whatever computed it. The plain kernels (builder/overlap/overlap.h) are the reference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "builder/overlap/overlap.h"

namespace svdag {

// A plane and a brick (builder/descend/plane_memo.h): voxel bit 8 * o + i is set for the offsets
// outer[o] + inner[i] + [0, span].
struct PlaneBrick {
  int64_t inner[8], outer[8];
  int64_t span;
};
// The voxels that are set for every offset of [low, high], and the largest range around it of which
// the same is true. `straddles`: some voxel is set for a part of [low, high] only.
struct PlaneVoxels {
  Brick voxels;
  int64_t low, high;
  bool straddles;
};

constexpr int64_t kFarOffset = std::numeric_limits<int64_t>::max() / 2;  // beyond every offset

struct Kernels {
  // out[i] of `count` entries: the children of the cube at `corner` with side `side` (lattice
  // units, a power of two) that the triangle may touch.
  using Children = void (*)(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                            int64_t side, ChildOverlap* out) noexcept;
  // The voxels of `wanted` that one of the entries sets, in the brick at `corner`.
  using Voxels = Brick (*)(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                           int fraction, Brick wanted, DecisionCounts* counts) noexcept;

  using Plane = PlaneVoxels (*)(const PlaneBrick& plane, int64_t low, int64_t high) noexcept;

  const char* name;  // of the instruction set
  int lanes;         // floats in a vector
  Children children;
  Voxels conservative;
  Voxels thin;
  Plane plane;
};

// One triangle after the other, by builder/overlap/overlap.h.
const Kernels& plain_kernels();
// The fastest of this processor.
const Kernels& kernels();
// Every vector width that was compiled and that this processor has, best first.
std::vector<Kernels> vector_kernels();
// Those of one name, "plain" included, in whatever case; a name that is unknown or that this
// processor lacks is an Error (kUsage).
const Kernels& kernels_by_name(const std::string& name);

}  // namespace svdag
