// Last phase: runs and the roots of their cells become one global DAG, written as it is merged.
//
// Since a run is closed and sorted by the same order as every other, run rank -> global index is
// strictly increasing on each level. Rewriting children by an increasing map keeps a sorted level
// sorted, so one k-way merge per level, bricks first, is all: no second sort, no random access but
// in the maps. The nodes above the cells (the top tree) enter as one more sorted source per level.
// "Global index" is already the word index that the file stores; it ascends like the rank.
//
// Nothing but the maps of one level must fit in memory, and not even those: where they do not, a
// map is spilled, and each run's next level is rewritten by itself, with one map loaded, before it
// is merged (builder/rank_maps.h). A run is as small as the node table that it was, so its map
// always fits. More sources than may be open at once are merged in groups first; the maps into and
// out of a group are both increasing, so composing them is sequential as well.
//
// The result is the minimal DAG, byte for byte what reducing the whole octree at once would give.
#pragma once

#include <span>
#include <vector>

#include "builder/run.h"
#include "builder/scratch.h"
#include "builder/top_tree.h"
#include "io/dag/dag_writer.h"
#include "streaming/executor.h"

namespace svdag {

struct MergeConfig {
  MemoryBudget* budget = nullptr;  // required
  Scratch* scratch = nullptr;      // null: all runs are in memory, and all maps shall be
  uint64_t map_bytes = 0;          // maps of two levels that need more are spilled
  size_t sources = 2;              // that may be open at once, if they are spilled; at least 2
};

// Writes all levels to `writer` (which the caller finishes) and uses the runs up. The cells must be
// disjoint.
void merge(std::span<Run> runs, std::vector<CellRoot> roots, int levels, const MergeConfig& config,
           DagWriter* writer, Executor* executor);

}  // namespace svdag
