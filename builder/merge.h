// Last phase: runs and the roots of their cells become one global DAG, written as it is merged.
//
// Since a run is closed and sorted by the same order as every other, run rank -> global index is
// strictly increasing on each level. Rewriting children by an increasing map keeps a sorted level
// sorted, so one k-way merge per level, bricks first, is all: no second sort, no random access but
// the maps. The nodes above the cells (the top tree) enter as one more sorted sequence per level.
// "Global index" is already the word index that the file stores; it ascends like the rank.
//
// The result is the minimal DAG, byte for byte what reducing the whole octree at once would give.
#pragma once

#include <span>
#include <vector>

#include "builder/cell.h"
#include "builder/run.h"
#include "io/dag/dag_writer.h"
#include "streaming/executor.h"

namespace svdag {

// Where the sub-DAG of a cell stands: node `rank` of the cell's level in run `run`.
struct CellRoot {
  Cube cell;
  uint32_t run;
  uint32_t rank;
};

// Writes all levels to `writer` (which the caller finishes) and uses the runs up. The cells must be
// disjoint.
void merge(std::span<Run> runs, std::span<const CellRoot> roots, int levels, DagWriter* writer,
           Executor* executor);

}  // namespace svdag
