// Last phase of a bake: merges runs and the roots of their cells into one DAG, written as it is
// merged.
//
// All runs are closed and sorted in the same order, so on each level the map from the rank in a run
// to the global index is strictly increasing. Rewriting children by an increasing map keeps a
// sorted level sorted, so one k-way merge per level, bricks first, is enough: no second sort, and
// no random access except in the maps. The nodes above the cells (the top tree) are one more sorted
// source per level. "Global index" is the word index that the file stores; it ascends like the
// rank.
//
// Neither a level nor its maps need to fit in memory. Maps that do not fit are spilled, and the
// next level of each run is then rewritten separately before it is merged, with one map loaded
// (builder/merge/rank_maps.h), or a window of one if even that is too large. Windows are applied
// from the last to the first: an increasing map lowers no number, so the numbers that a window
// wrote are above all later windows, and one stream can hold old and new numbers. If there are
// more sources than may be open at once, they are first merged in groups; the maps into and out of
// a group are both increasing, so composing them is sequential too.
//
// The result is the minimal DAG, byte for byte the reduction of the whole octree; for a part of the
// grid it is one closed run with a sub-DAG per top of the part (builder/octree/grid_part.h).
#pragma once

#include <span>
#include <vector>

#include "builder/reduce/run.h"
#include "builder/run/bake_output.h"
#include "builder/workspace/scratch.h"
#include "streaming/process/executor.h"
#include "streaming/process/progress.h"

namespace svdag {

struct MergeConfig {
  MemoryBudget* budget = nullptr;      // required
  Scratch* scratch = nullptr;          // null: all runs are in memory, and maps are not spilled
  uint64_t map_bytes = 0;              // maps of two levels that need more are spilled
  uint64_t window_bytes = UINT64_MAX;  // of a spilled map that each worker loads at a time
  size_t max_sources = 2;              // spilled sources that may be open at once; at least 2
  Progress* progress = nullptr;        // null: not shown
  bool with_union = true;              // false: the union has no root
};

// Shares of the budget for a merge by `workers` workers, where an open source takes `source_bytes`.
// `scratch`, `progress`: as in MergeConfig.
MergeConfig share_for_merge(MemoryBudget* budget, Scratch* scratch, size_t workers,
                            uint64_t source_bytes, Progress* progress = nullptr);

// Writes all levels to `output` and returns the roots of the tops of `part`, with which the caller
// finishes the output. Empties `runs`. The cells must be disjoint and inside the part.
std::vector<SubDagRoot> merge(std::span<Run> runs, std::vector<SubDagRoot> roots,
                              const GridPart& part, const MergeConfig& config, BakeOutput* output,
                              Executor* executor);

}  // namespace svdag
