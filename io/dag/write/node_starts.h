// The indices of the nodes of a level, to store values per node instead of per index: the words of
// the plain layout at which a node begins.
#pragma once

#include "io/dag/dag_view.h"
#include "streaming/memory/rank_bitmap.h"

namespace svdag {

// `level` < L-2.
inline RankBitmap node_starts(const DagView& dag, uint32_t level, MemoryBudget* budget) {
  RankBitmap starts(budget, "numbers of nodes");
  for (uint64_t i = 0; i < dag.index_end[level]; i = dag_next(dag, level, i))
    starts.set(uint32_t(i));
  starts.seal();
  return starts;
}

}  // namespace svdag
