// Reduces a graph to the minimal DAG of its sets, level by level, without expanding it: how every
// file is made from files.
//
// This is the reduction of Kämpe et al. 2013, section 4, applied to a graph instead of a tree.
// First the nodes reachable from the roots are marked, top-down. Then each level, bricks first, is
// sorted by content, equal nodes get one index and are written, and the level above looks up the
// indices of its children. Sorted content is the canonical order, so the result has the same bytes
// as a bake of these voxels. Empty nodes, and nodes that lead only to empty nodes, are dropped.
//
// Facts about a graph spare steps. Nodes of a plain file ascend already: they are not sorted, but
// merged with the nodes that are (the new nodes of a union of layers). If all nodes of a file are
// in use, none is marked. If the voxels of the sets are known, none is counted.
//
// Memory: 1.5 bits per id in use, and an index (4 bytes) and a voxel count (8 bytes) per node of
// two levels, in WorkArrays; sorting spills (streaming/sort/external_sort.h). Rejected: postorder
// with a hash table of nodes, as in the bake: spilled entries of the table must be looked up again
// for every shared node.
#pragma once

#include "io/dag/graph/node_graph.h"
#include "io/dag/write/dag_writer.h"
#include "streaming/process/executor.h"

namespace svdag {

struct ReducedGraph {
  uint64_t voxels;  // of the union, or of the only set
  int spilled;      // number of sorts that did not fit in memory
};

// Writes all levels to `writer`, which the caller finishes with `layers` and `voxels`. `layers`
// describes the sets of the graph: the union, if the table has it, and the layers. A graph without
// layers has one set. Their roots and voxels are set here.
ReducedGraph reduce(NodeGraph* graph, const WorkRoom& room, Executor* executor, DagWriter* writer,
                    LayerTable* layers);

}  // namespace svdag
