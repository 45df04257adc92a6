// A view of a 64-tree: the DAG with its levels taken two at a time; only for tracing.
//
// Idea: bricks are cubes of 4^3 cells already, 64 bits; so every node is one. This halves the depth
// (7 nodes instead of 13 at 16K^3), and the cells that a ray meets are found for 64 cells at once
// (cells64.h). It is still a DAG: subtrees that the file shares over two levels are shared here.
//
// Notation: a node of depth d (the root's is 0) has cells of side 4^(depth - d); cells of depth
// `depth` are the bricks, whose cells are voxels. Cell 8b + c is child c of child b, as the bits of
// a brick, on all depths. A node is a u64 mask of its cells, followed by
//
//   d + 1 < depth   per present cell, ascending, a u32: the child's index in `words`
//   d + 1 = depth   per present cell the brick itself, which saves a pointer and a cache miss
//
// If the DAG has an odd number of levels, the root's cube is twice as wide as the grid and repeats
// it, so that mirroring (ray.h) needs no exception; clipped rays end before they reach the copy.
//
// Depends only on dag_view.h, for host and CUDA. verify/trace/kernel/tree64.h builds it.
#pragma once

#include "io/dag/dag_view.h"

namespace svdag {

constexpr uint32_t kMaxDepth = (kMaxSections + 1) / 2;

struct Tree64View {
  const uint64_t* words = nullptr;  // the root is at index 0; null: an empty tree
  uint32_t levels = 0;              // of the DAG
  uint32_t depth = 0;
  double side[kMaxDepth + 1] = {};      // [d]: of the cells of nodes of depth d
  double per_side[kMaxDepth + 1] = {};  // 1 / side

  SVDAG_HD bool empty() const { return words == nullptr; }
  SVDAG_HD uint32_t resolution() const { return 1U << levels; }
};

// v must not be 0.
SVDAG_HD inline uint32_t lowest_bit64(uint64_t v) {
#if defined(__CUDA_ARCH__)
  return uint32_t(__ffsll(static_cast<long long>(v)) - 1);
#else
  return uint32_t(__builtin_ctzll(v));
#endif
}

// Mask of the cells of a node with coordinate `at` (0 .. 3) on an axis.
SVDAG_HD inline uint64_t slab64(int axis, unsigned at) {
  const uint64_t odd = axis == 0   ? 0xf0f0f0f0f0f0f0f0U
                       : axis == 1 ? 0xccccccccccccccccU
                                   : 0xaaaaaaaaaaaaaaaaU;
  const uint64_t upper = axis == 0   ? 0xffffffff00000000U
                         : axis == 1 ? 0xffff0000ffff0000U
                                     : 0xff00ff00ff00ff00U;
  return (at & 1U ? odd : ~odd) & (at & 2U ? upper : ~upper);
}

// The coordinate of a cell on an axis.
SVDAG_HD inline unsigned cell64_at(unsigned cell, int axis) {
  return (cell >> (5 - axis) & 1U) << 1 | (cell >> (2 - axis) & 1U);
}

}  // namespace svdag
