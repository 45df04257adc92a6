// A DAG of another program becomes the minimal one, level by level, without being unpacked.
//
// Reduction (Kämpe et al. 2013, section 4) of a graph instead of a tree: first the nodes that the
// root reaches are marked, top-down; then each level, bricks first, is sorted by content, equal
// nodes get one index and are written, and the level above looks its children up. Sorted content is
// the canonical order, so the result is the same bytes that a bake of these voxels gives.
//
// Memory: a bit and a half per id that is in use, an index and a count per node of two levels;
// sorting spills (streaming/sort/external_sort.h). Nodes that are empty vanish with all that leads
// to nothing else. Rejected: postorder with a hash table of nodes, as the bake has it: what the
// table has spilled must be looked up again for every shared node.
#pragma once

#include <functional>

#include "builder/run/bake_output.h"
#include "io/dag/node_graph.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/process/executor.h"

namespace svdag {

struct ReductionRoom {
  MemoryBudget* budget;
  uint64_t sort_bytes;  // maximum size of the buffers of one sort
  Executor* executor;
  std::function<File()> new_file;  // for what does not fit in memory
};

// Writes all levels to `output` (which the caller finishes); returns the number of set voxels.
uint64_t reduce_graph(NodeGraph* graph, const ReductionRoom& room, BakeOutput* output);

}  // namespace svdag
