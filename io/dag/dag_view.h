// A view of a `.svdag` file in memory, used without decoding, by host and CUDA code. No
// dependencies.
//
// Notation: level 0 is the root; a node of level k is a cube of side 2^(L-k) voxels; bricks are at
// level L-2. An inner node is a word whose low 8 bits are the child mask, followed by one word per
// present child, ascending: the index of the child's first word in the section of the next level,
// or the index of the brick. Pointers lead to the next level only.
#pragma once

#include "format.h"  // beside this file: the two are used alone

#if defined(__CUDACC__)
#define SVDAG_HD __host__ __device__
#else
#define SVDAG_HD
#endif

namespace svdag {

constexpr uint32_t kNoChild = 0xffffffffU;

struct DagView {
  uint32_t levels = 0;                       // L
  const uint32_t* words[kMaxSections] = {};  // sections of levels 0 .. L-3
  uint64_t word_count[kMaxSections] = {};
  const uint64_t* bricks = nullptr;  // section of level L-2
  uint64_t brick_count = 0;
  double corner[3] = {0, 0, 0};  // world position of the corner of voxel (0, 0, 0)
  double voxel_size = 1;         // in world units

  SVDAG_HD bool empty() const { return brick_count == 0; }
  SVDAG_HD uint32_t resolution() const { return 1U << levels; }
  SVDAG_HD uint32_t brick_level() const { return levels - 2; }
};

SVDAG_HD inline int popcount8(uint32_t v) {
#if defined(__CUDA_ARCH__)
  return __popc(v);
#else
  return __builtin_popcount(v);
#endif
}

// The coordinate `world` of `axis` in voxels: voxel k is [k, k+1). World coordinates are those of
// the scene after --transform, --up and --scale.
SVDAG_HD inline double voxel_from_world(const DagView& dag, int axis, double world) {
  return (world - dag.corner[axis]) / dag.voxel_size;
}

// The child c (0 .. 7) of the node at word `node` of level `level`, or kNoChild.
SVDAG_HD inline uint32_t dag_child(const DagView& dag, uint32_t level, uint32_t node, unsigned c) {
  const uint32_t* word = dag.words[level] + node;
  const uint32_t mask = word[0] & 0xffU;
  if (!((mask >> c) & 1U)) return kNoChild;
  return word[1 + popcount8(mask & ((1U << c) - 1U))];
}

// The brick that holds voxels (4x..4x+3, 4y..4y+3, 4z..4z+3); 0 where nothing is set.
SVDAG_HD inline uint64_t dag_brick(const DagView& dag, uint32_t x, uint32_t y, uint32_t z) {
  if (dag.empty()) return 0;
  uint32_t node = 0;
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    const uint32_t shift = dag.brick_level() - 1 - level;
    const unsigned c = 4 * ((x >> shift) & 1U) + 2 * ((y >> shift) & 1U) + ((z >> shift) & 1U);
    node = dag_child(dag, level, node, c);
    if (node == kNoChild) return 0;
  }
  return dag.bricks[node];
}

// Whether voxel (x, y, z) is set.
SVDAG_HD inline bool dag_voxel(const DagView& dag, uint32_t x, uint32_t y, uint32_t z) {
  const unsigned outer = 4 * ((x >> 1) & 1U) + 2 * ((y >> 1) & 1U) + ((z >> 1) & 1U);
  const unsigned inner = 4 * (x & 1U) + 2 * (y & 1U) + (z & 1U);
  return (dag_brick(dag, x >> 2, y >> 2, z >> 2) >> (8 * outer + inner)) & 1U;
}

// A view of the file at `data` (8-byte aligned). The file must have been validated
// (io/dag/check.h).
inline DagView dag_view(const void* data) {
  const Header& header = *static_cast<const Header*>(data);
  const char* base = static_cast<const char*>(data);
  DagView view;
  view.levels = header.levels;
  view.voxel_size = header.voxel_size;
  for (int a = 0; a < 3; ++a) view.corner[a] = header.corner[a];
  for (uint32_t level = 0; level + 2 < header.levels; ++level) {
    view.words[level] = reinterpret_cast<const uint32_t*>(base + header.sections[level].offset);
    view.word_count[level] = header.sections[level].bytes / 4;
  }
  const Section& bricks = header.sections[header.levels - 2];
  view.bricks = reinterpret_cast<const uint64_t*>(base + bricks.offset);
  view.brick_count = bricks.nodes;
  return view;
}

}  // namespace svdag
