// How the memory budget is divided: every share that a phase may take is defined here.
#pragma once

#include <cstddef>
#include <cstdint>

namespace svdag {

// Shares in bytes. Phases run one after the other, so all shares together exceed the budget.
struct MemoryShares {
  explicit MemoryShares(uint64_t memory, size_t workers = 1)
      : vertices(memory / 4),
        triangles(memory / 4),
        table(memory / 2 / workers),
        sort(memory / 4),
        brick_table(memory / 4),
        pilot_table(memory / 4),
        open_bins(memory / 8),
        maps(memory / 2),
        map_window(maps / workers),
        sources(memory * 3 / 8),
        check_bitmap(memory / 4 / workers),
        cache_index(memory / 16),
        cache_marks(memory / 8) {}

  uint64_t vertices;      // vertex positions of the mesh being read
  uint64_t triangles;     // triangles of the cells being voxelized
  uint64_t table;         // node table of one worker
  uint64_t sort;          // external sort of an import
  uint64_t brick_table;   // node table of an import
  uint64_t pilot_table;   // node table of a plan's pilot bake
  uint64_t open_bins;     // bins that a plan writes at once
  uint64_t maps;          // rank maps of the merge
  uint64_t map_window;    // window of a spilled rank map, per worker
  uint64_t sources;       // blocks of the runs being merged
  uint64_t check_bitmap;  // bitmap of one worker that checks a .run file
  uint64_t cache_index;   // index of a cell cache's packs
  uint64_t cache_marks;   // marks in one pack while cells are taken from it
};

}  // namespace svdag
