// Last phase: runs and the roots of their cells become one global DAG, written as it is merged.
//
// Since a run is closed and sorted by the same order as every other, run rank -> global index is
// strictly increasing on each level. Rewriting children by an increasing map keeps a sorted level
// sorted, so one k-way merge per level, bricks first, is all: no second sort, no random access but
// in the maps. The nodes above the cells (the top tree) enter as one more sorted source per level.
// "Global index" is already the word index that the file stores; it ascends like the rank.
//
// No level must fit in memory, nor its maps: where those do not, they are spilled, and each run's
// next level is rewritten by itself before it is merged, with one map loaded
// (builder/merge/rank_maps.h), a window at a time where even that is too large. Windows go from the
// last to the first: an ascending map lowers no number, so what a window rewrote is beyond all
// windows that follow, and one stream holds both old and new numbers. More sources than may be open
// at once are merged in groups first; the maps into and out of a group are both increasing, so
// composing them is sequential as well.
//
// The result is the minimal DAG, byte for byte what reducing the whole octree at once would give;
// or, of a part of the grid, a sub-DAG per top of the part (builder/octree/grid_part.h), in one
// closed run.
#pragma once

#include <span>
#include <vector>

#include "builder/octree/sub_dag_root.h"
#include "builder/reduce/run.h"
#include "builder/run/bake_output.h"
#include "builder/workspace/scratch.h"
#include "streaming/process/executor.h"

namespace svdag {

struct MergeConfig {
  MemoryBudget* budget = nullptr;      // required
  Scratch* scratch = nullptr;          // null: all runs are in memory, and all maps shall be
  uint64_t map_bytes = 0;              // maps of two levels that need more are spilled
  uint64_t window_bytes = UINT64_MAX;  // of a spilled map, loaded at a time by each worker
  size_t max_sources = 2;              // that may be open at once, if they are spilled; at least 2
};

// What a merge by `workers` takes of the budget, where an open run takes `source_bytes`. `scratch`:
// as in MergeConfig.
MergeConfig share_for_merge(MemoryBudget* budget, Scratch* scratch, size_t workers,
                            uint64_t source_bytes);

// Writes all levels to `output`, which the caller finishes with the roots that this returns: those
// of the tops of `part`. Uses the runs up. The cells must be disjoint and lie in the part.
std::vector<SubDagRoot> merge(std::span<Run> runs, std::vector<SubDagRoot> roots,
                              const GridPart& part, const MergeConfig& config, BakeOutput* output,
                              Executor* executor);

}  // namespace svdag
