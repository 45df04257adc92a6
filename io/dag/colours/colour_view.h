// A view of the colours of a `.svdag` file in memory, by host and CUDA code. No dependencies but
// io/dag/dag_view.h.
//
// A file has a colour for every cube of level K (the colour level) with a set voxel, and for those
// of the levels K-2, K-4, ... their mean. In depth-first order, a cube before its descendants, each
// has a number. So the number of a cube is that of its parent, plus what the node's own colour and
// the siblings before it take: one count per node gives all numbers. The counts are made by
// io/dag/colours/dag_colours.h, not stored.
#pragma once

#include "../dag_view.h"
#include "chunk_view.h"

namespace svdag {

// A number per node of a level, as wide as the level needs.
struct LevelCounts {
  const void* counts = nullptr;
  uint32_t bytes = 0;  // 1, 2, 4, 8

  SVDAG_HD uint64_t operator[](uint64_t i) const {
    switch (bytes) {
      case 1:
        return static_cast<const uint8_t*>(counts)[i];
      case 2:
        return static_cast<const uint16_t*>(counts)[i];
      case 4:
        return static_cast<const uint32_t*>(counts)[i];
      default:
        return static_cast<const uint64_t*>(counts)[i];
    }
  }
};

// The number of colours of each node's cube, or, without means, of its cubes of level K.
struct ColourCounts {
  uint32_t level = 0;  // K
  bool with_means = true;
  LevelCounts levels[kMaxSections];  // levels 1 .. min(K - 1, L - 3)

  // The means of the levels K, K-2, ...
  SVDAG_HD uint32_t own(uint32_t k) const {
    return k == level || (with_means && (level - k) % 2 == 0) ? 1 : 0;
  }
  // A brick's; K >= L-2.
  SVDAG_HD uint64_t of_brick(uint64_t brick, uint32_t brick_level) const {
    if (level == brick_level) return 1;
    if (level == brick_level + 1) return uint64_t(popcount8(octants(brick)));
    return own(brick_level) + uint64_t(popcount64(brick));
  }
  // The node of level k <= K at `index`; not the root.
  SVDAG_HD uint64_t of(const DagView& dag, uint32_t k, uint32_t index) const {
    if (k == level) return 1;
    if (k == dag.brick_level()) return of_brick(dag.bricks[index], k);
    return levels[k][slot(dag.layout, index)];
  }
  // Where the count of the node at `index` is. Nodes of the plain layout have two words or more.
  SVDAG_HD static uint64_t slot(Layout layout, uint64_t index) {
    return layout == Layout::kPlain ? index / 2 : index;
  }
  // The mask of the octants of a brick that have voxels.
  SVDAG_HD static uint32_t octants(uint64_t brick) {
    uint32_t mask = 0;
    for (uint32_t c = 0; c < 8; ++c) mask |= uint32_t((brick >> 8 * c & 0xffU) != 0) << c;
    return mask;
  }
};

struct ColourView {
  DagView dag;  // of the whole file: its first root
  ColourCounts counts;
  const ColourEntry* entries = nullptr;
  uint64_t entry_count = 0;
  const uint32_t* chunks = nullptr;

  SVDAG_HD uint32_t level() const { return counts.level; }
};

// Colour number `number`, which must be less than the file's number of colours.
SVDAG_HD inline uint32_t colour_at(const ColourView& view, uint64_t number) {
  uint64_t low = 0;
  for (uint64_t high = view.entry_count; high - low > 1;) {
    const uint64_t middle = low + (high - low) / 2;
    (view.entries[middle].first <= number ? low : high) = middle;
  }
  const ColourEntry& entry = view.entries[low];
  if ((entry.value & kChunkEntry) == 0) return uint32_t(entry.value);
  return chunk_colour(view.chunks + (entry.value & ~kChunkEntry), uint32_t(number - entry.first));
}

// The colour of the cube of `level` at (x, y, z), in units of its side: r | g << 8 | b << 16, sRGB.
// A cube finer than K, or between two levels with colours, has that of the next coarser one.
// kNoColour if the cube has no set voxel, is a full cube of a solid that no triangle touches, or
// is the whole grid and K is odd.
SVDAG_HD inline uint32_t svdag_colour(const ColourView& view, uint32_t level, uint32_t x,
                                      uint32_t y, uint32_t z) {
  const DagView& dag = view.dag;
  const ColourCounts& counts = view.counts;
  const uint32_t finest = view.level(), brick_level = dag.brick_level();
  uint32_t coarser = level > finest ? level - finest : (finest - level) % 2;
  if (dag.empty() || coarser > level) return kNoColour;
  level -= coarser;
  x >>= coarser, y >>= coarser, z >>= coarser;
  uint64_t number = 0;
  uint32_t node = 0;
  for (uint32_t k = 0; k < level; ++k) {
    number += counts.own(k);
    const uint32_t c = octant_of(x, y, z, level - 1 - k);
    if (k == brick_level) {
      const uint64_t brick = dag.bricks[node];
      if (level == k + 1) {  // K = L-1
        const uint32_t octants = ColourCounts::octants(brick);
        if (!(octants >> c & 1U)) return kNoColour;
        return colour_at(view, number + uint64_t(popcount8(octants & ((1U << c) - 1))));
      }
      const uint32_t bit = 8 * c + octant_of(x, y, z, 0);
      if (!(brick >> bit & 1U)) return kNoColour;
      return colour_at(view, number + uint64_t(popcount64(brick & ((uint64_t(1) << bit) - 1))));
    }
    const uint32_t mask = dag_mask(dag, k, node);
    if (!(mask >> c & 1U)) return kNoColour;
    for (uint32_t before = mask & ((1U << c) - 1U); before != 0; before &= before - 1) {
      uint32_t sibling = 0;
      while (!(before >> sibling & 1U)) ++sibling;
      number += counts.of(dag, k + 1, dag_present_child(dag, k, node, sibling));
    }
    node = dag_present_child(dag, k, node, c);
  }
  return colour_at(view, number);
}

}  // namespace svdag
