// Reduces a DAG of another program to the minimal one, level by level, without expanding it.
//
// This is the reduction of Kämpe et al. 2013, section 4, applied to a graph instead of a tree.
// First the nodes reachable from the roots are marked, top-down. Then each level, bricks first, is
// sorted by content, equal nodes get one index and are written, and the level above looks up the
// indices of its children. Sorted content is the canonical order, so the result has the same bytes
// as a bake of these voxels. Empty nodes, and nodes that lead only to empty nodes, are dropped.
//
// Memory: 1.5 bits per id in use, and an index and a voxel count per node of two levels; sorting
// spills (streaming/sort/external_sort.h). Rejected: postorder with a hash table of nodes, as in
// the bake: spilled entries of the table must be looked up again for every shared node.
#pragma once

#include <functional>
#include <vector>

#include "builder/run/bake_output.h"
#include "io/dag/node_graph.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/process/executor.h"

namespace svdag {

struct ReductionConfig {
  MemoryBudget* budget;
  uint64_t sort_bytes;  // maximum size of the buffers of one sort
  Executor* executor;
  std::function<File()> new_file;  // creates a scratch file for sorted runs
};

// A set of voxels of the graph.
struct ReducedSet {
  uint32_t root;  // what add_node() returned; kNoRoot if no voxel is set
  uint64_t voxels;
};

// Writes all levels to `output`, which the caller finishes. Returns a set for each root.
std::vector<ReducedSet> reduce_graph(NodeGraph* graph, const ReductionConfig& config,
                                     DagOutput* output);

}  // namespace svdag
