// How a bake shares out its memory.
#pragma once

#include <cstddef>
#include <cstdint>

namespace svdag {

// Phases follow each other, so the sum of all is more than the whole.
struct Shares {
  Shares(uint64_t memory, size_t workers)
      : vertices(memory / 4),
        triangles(memory / 4),
        table(memory / 2 / workers),
        maps(memory / 2),
        sources(memory * 3 / 8),
        index(memory / 16),
        marks(memory / 8) {}

  uint64_t vertices;   // of a mesh being read
  uint64_t triangles;  // of the cells being voxelized
  uint64_t table;      // a worker's unique nodes
  uint64_t maps;       // of the merge
  uint64_t sources;    // blocks of the runs being merged
  uint64_t index;      // of a cell cache: what is known of its packs
  uint64_t marks;      // of one of its packs, while cells are taken from it
};

}  // namespace svdag
