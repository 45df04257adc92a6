// The inner loops of the descent, one version per instruction set, chosen at run time.
//
// A kernel takes a whole list, so the run-time choice costs one indirect call per cube, not per
// triangle. A vector holds the 8 children of a cube or rows of the 64 voxels of a brick: lanes are
// positions, and triangles are processed one after the other. Rejected: lanes as triangles (lists
// are short near the bricks, and each triangle has other undecided edges).
//
// The results are the same bits on every machine. A child may be reported as touched although it is
// not (the safe side), but every vector target computes the same numbers in the same order, without
// fused multiply-add. Voxels are exact on every target. The plain kernels
// (builder/overlap/overlap.h) are the reference.
//
// Rejected as well: fused multiply-add (no gain, and unsure values would differ between
// instruction sets), prefetches of the next triangle, and leaving a triangle as soon as a
// projection leaves no voxel (no difference).
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
// Result for offsets in [low, high]: the voxels that are set for all of them, and the largest range
// around them with the same voxels. `straddles`: some voxel is set for only a part of [low, high].
struct PlaneVoxels {
  Brick voxels;
  int64_t low, high;
  bool straddles;
};

// The heights of a plane over the corners of the 8x8 columns of a cube of 8x8x8 voxels
// (builder/descend/plane_contents.h), in units of 2^-kHeightBits voxels: h(i, j) = first - i step_u
// - j step_v for 0 <= i, j <= 8 without (0, 8) and (8, 0), clamped to [-1/2, 8 1/2]. 0 <= step_u,
// step_v <= 1 voxel; -4 <= first <= 24 voxels.
constexpr int kHeightBits = 26;
constexpr int32_t kHeightFraction = (1 << kHeightBits) - 1;
constexpr int32_t kMinHeight = -(1 << (kHeightBits - 1)), kMaxHeight = -17 * kMinHeight;
// Whether the whole part of each height is odd, and the range of their fractions.
struct ColumnParities {
  uint64_t rows;  // bit 8 i + j: h(i, j), for i, j < 8
  uint32_t last;  // from bit 0: h(8, 8), h(8, 1 .. 7); from bit 8: h(1, 8), h(1 .. 7, 8)
  int32_t min_fraction, max_fraction;
};

// The voxels of a brick by slabs of height k: bit 16 k + 4 i + j is set iff k <= h(i, j) and
// h(i, j) - drop < k + 1, for heights h(i, j) = first - i step_u - j step_v as above, not clamped.
using BrickSlabs = uint64_t;

constexpr int64_t kFarOffset = std::numeric_limits<int64_t>::max() / 2;  // beyond every offset

// The kernels of a rule.
struct RuleKernels {
  // The voxels among `candidates` that any of the entries sets, in the brick at `corner`.
  using BrickVoxels = Brick (*)(const ListedTriangle* entries, size_t count,
                                const LatticePoint& corner, int fraction, Brick candidates,
                                DecisionCounts* counts) noexcept;
  // The voxels of the cube of 8^3 at `corner`: out[c], the brick of child c. As Kernels::children
  // and `brick` for each child, but without lists. `covering`: see OverlapConfig. Returns the
  // number of voxels.
  using CubeVoxels = uint32_t (*)(const ListedTriangle* entries, size_t count,
                                  const LatticePoint& corner, int fraction, bool covering,
                                  Brick out[8], DecisionCounts* counts) noexcept;

  BrickVoxels brick;
  CubeVoxels cube;
};

struct Kernels {
  // Sets out[i], for each of `count` entries, to the children of a cube that the triangle may
  // touch. The cube has the minimum corner `corner` and the side `side` (lattice units, a power of
  // two).
  using Children = void (*)(const ListedTriangle* entries, size_t count, const LatticePoint& corner,
                            int64_t side, ChildOverlap* out) noexcept;
  using Plane = PlaneVoxels (*)(const PlaneBrick& plane, int64_t low, int64_t high) noexcept;

  using Heights = ColumnParities (*)(int32_t first, int32_t step_u, int32_t step_v) noexcept;
  using Slabs = BrickSlabs (*)(int32_t first, int32_t step_u, int32_t step_v,
                               int32_t drop) noexcept;

  const char* name;  // of the instruction set
  int lanes;         // floats per vector
  Children children;
  RuleKernels conservative;
  RuleKernels thin;
  Plane plane;
  Heights heights;
  Slabs slabs;
};

// The reference: one triangle after the other, by builder/overlap/overlap.h.
const Kernels& plain_kernels();
// The fastest kernels for this processor.
const Kernels& kernels();
// The vector kernels of every compiled instruction set that this processor has, best first.
std::vector<Kernels> vector_kernels();
// Kernels by the name of their instruction set or "plain", ignoring case; Error (kUsage) if the
// name is unknown or this processor lacks the instruction set.
const Kernels& kernels_by_name(const std::string& name);

}  // namespace svdag
