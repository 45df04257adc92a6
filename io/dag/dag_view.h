// A view of a `.svdag` file in memory, used without decoding, by host and CUDA code. No
// dependencies.
//
// Notation: level 0 is the root; a node of level k is a cube of side 2^(L-k) voxels; bricks are at
// level L-2. A node is known by an index, which is private to the layout of the file; the root has
// index 0. Children are in the next level only.
//
// A file with layers has further roots in level 0. The view of a layer (DagFile::view_of) has its
// root at index 0 instead. So what index 0 reaches, not whole sections, are a view's voxels.
//
// Plain layout: a node is a word whose low 8 bits are the child mask, followed by one word per
// present child, ascending: the child's index. The index of a node is that of its first word in the
// section of its level, the index of a brick its number.
// Compact layout: io/dag/compact_view.h. The index of a node is its number.
#pragma once

#include <cstring>
#include <optional>

#include "compact_view.h"  // beside this file, as format.h: the three are used without other files

namespace svdag {

constexpr uint32_t kNoChild = 0xffffffffU;

struct DagView {
  uint32_t levels = 0;  // L
  Layout layout = Layout::kPlain;
  const uint32_t* words[kMaxSections] = {};  // plain: sections of levels 0 .. L-3
  CompactLevel compact[kMaxSections];        // compact: the same
  uint64_t index_end[kMaxSections] = {};     // the indices of a level's nodes are less
  const uint64_t* bricks = nullptr;          // section of level L-2
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

// The number (io/brick.h) of the child cube, of side 2^shift, that holds voxel (x, y, z).
SVDAG_HD inline unsigned octant_of(uint32_t x, uint32_t y, uint32_t z, uint32_t shift) {
  return (x >> shift & 1U) << 2 | (y >> shift & 1U) << 1 | (z >> shift & 1U);
}

// The child mask of the node at `index` of `level` < brick_level().
SVDAG_HD inline uint32_t dag_mask(const DagView& dag, uint32_t level, uint32_t index) {
  if (dag.layout == Layout::kPlain) return dag.words[level][index] & 0xffU;
  return dag.compact[level].mask(index);
}

// The child c (0 .. 7) of a node that has one.
SVDAG_HD inline uint32_t dag_present_child(const DagView& dag, uint32_t level, uint32_t index,
                                           unsigned c) {
  if (dag.layout != Layout::kPlain) return dag.compact[level].child(index, c);
  const uint32_t* word = dag.words[level] + index;
  return word[1 + popcount8(word[0] & ((1U << c) - 1U))];
}

// The child c (0 .. 7), or kNoChild.
SVDAG_HD inline uint32_t dag_child(const DagView& dag, uint32_t level, uint32_t index, unsigned c) {
  if (!(dag_mask(dag, level, index) >> c & 1U)) return kNoChild;
  return dag_present_child(dag, level, index, c);
}

// The index of the next node of a level, from 0 to index_end.
SVDAG_HD inline uint64_t dag_next(const DagView& dag, uint32_t level, uint64_t index) {
  if (dag.layout != Layout::kPlain) return index + 1;
  return index + 1 + uint64_t(popcount8(dag.words[level][index] & 0xffU));
}

// Calls visit(c, child) for each child c of a node, ascending.
template <class Visit>
void dag_for_children(const DagView& dag, uint32_t level, uint32_t index, const Visit& visit) {
  const bool plain = dag.layout == Layout::kPlain;
  const uint32_t* word = plain ? dag.words[level] + index : nullptr;
  for (uint32_t mask = dag_mask(dag, level, index); mask != 0; mask &= mask - 1) {
    const unsigned c = unsigned(__builtin_ctz(mask));
    visit(c, plain ? *++word : dag_present_child(dag, level, index, c));
  }
}

// The brick that holds voxels (4x..4x+3, 4y..4y+3, 4z..4z+3); 0 where nothing is set.
SVDAG_HD inline uint64_t dag_brick(const DagView& dag, uint32_t x, uint32_t y, uint32_t z) {
  if (dag.empty()) return 0;
  uint32_t node = 0;
  for (uint32_t level = 0; level < dag.brick_level(); ++level) {
    node = dag_child(dag, level, node, octant_of(x, y, z, dag.brick_level() - 1 - level));
    if (node == kNoChild) return 0;
  }
  return dag.bricks[node];
}

// Whether voxel (x, y, z) is set.
SVDAG_HD inline bool dag_voxel(const DagView& dag, uint32_t x, uint32_t y, uint32_t z) {
  const unsigned bit = 8 * octant_of(x, y, z, 1) + octant_of(x, y, z, 0);
  return (dag_brick(dag, x >> 2, y >> 2, z >> 2) >> bit) & 1U;
}

// A view of the file at `data` (8-byte aligned). The file must have been validated
// (io/dag/check.h).
inline DagView dag_view(const void* data) {
  const Header& header = *static_cast<const Header*>(data);
  const char* base = static_cast<const char*>(data);
  DagView view;
  view.levels = header.levels;
  view.layout = Layout(header.layout);
  view.voxel_size = header.voxel_size;
  for (int a = 0; a < 3; ++a) view.corner[a] = header.corner[a];
  for (uint32_t level = 0; level + 2 < header.levels; ++level) {
    const Section& section = header.sections[level];
    if (view.layout == Layout::kPlain) {
      view.words[level] = reinterpret_cast<const uint32_t*>(base + section.offset);
      view.index_end[level] = section.bytes / 4;
    } else if (section.nodes > 0) {
      view.compact[level] = CompactLevel(base + section.offset, section.nodes);
      view.index_end[level] = section.nodes;
    }
  }
  const Section& bricks = header.sections[header.levels - 2];
  view.bricks = reinterpret_cast<const uint64_t*>(base + bricks.offset);
  view.brick_count = bricks.nodes;
  return view;
}

// What is wrong with the `size` bytes of a file at `data`; null if they can be viewed. Finds
// another format, a truncated file and parts that are not inside. Damage within a part shows in the
// checksums (io/dag/check.h).
inline const char* dag_defect(const void* data, uint64_t size) {
  if (size < sizeof(Header)) return "is shorter than a header";
  if (reinterpret_cast<uintptr_t>(data) % 8 != 0) return "is not at an address divisible by 8";
  const Header& header = *static_cast<const Header*>(data);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0)
    return "is not a .svdag, or is packed (svdag unpack)";
  if (header.version < 1 || header.version > kMaxVersion) return "has an unknown version";
  if (header.levels < 3 || header.levels > kMaxSections + 1 || header.layout > 1)
    return "has an impossible header";
  if (header.file_bytes > size) return "is truncated";
  const bool compact = Layout(header.layout) == Layout::kCompact;
  for (uint32_t level = 0; level + 1 < header.levels; ++level) {
    const Section& section = header.sections[level];
    const bool bricks = level + 2 == header.levels;
    if (section.offset % 8 != 0 || section.offset > header.file_bytes ||
        section.bytes > header.file_bytes - section.offset || section.nodes > kMaxWords ||
        (bricks && section.bytes < 8 * section.nodes))
      return "has a section outside of the file";
    if (bricks || !compact || section.nodes == 0) continue;
    const char* const base = static_cast<const char*>(data) + section.offset;
    if (section.bytes < sizeof(CompactEntry) ||
        section.bytes < compact_bytes(*reinterpret_cast<const CompactEntry*>(base), section.nodes))
      return "has a section that is too short";
  }
  return nullptr;
}

// A view of the `size` bytes of a file at `data`; nothing if dag_defect() finds one.
inline std::optional<DagView> dag_view(const void* data, uint64_t size) {
  if (dag_defect(data, size) != nullptr) return std::nullopt;
  return dag_view(data);
}

// The view of a copy of a file: `view` is of the file at `from`, the copy is at `to`.
inline DagView moved_view(DagView view, const void* from, const void* to) {
  const auto move = [&](auto*& pointer) {
    using Byte = const char*;
    if (pointer == nullptr) return;
    const auto offset = reinterpret_cast<Byte>(pointer) - static_cast<Byte>(from);
    pointer = reinterpret_cast<decltype(+pointer)>(static_cast<Byte>(to) + offset);
  };
  for (uint32_t level = 0; level < kMaxSections; ++level) {
    move(view.words[level]);
    move(view.compact[level].lines);
    move(view.compact[level].bases);
    for (auto*& stream : view.compact[level].streams) move(stream);
  }
  move(view.bricks);
  return view;
}

}  // namespace svdag
