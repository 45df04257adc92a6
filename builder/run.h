// A run: the reduced levels of some cells, sorted, with every child inside the run.
//
// Invariant (closed and canonical): children are 1 + ranks in the run's own next level; each level
// is strictly ascending by NodeKey (bricks as numbers). Runs of different workers therefore agree
// on the order of the nodes they share, which is all that the merge needs.
#pragma once

#include <vector>

#include "builder/node_table.h"
#include "streaming/huge_vector.h"

namespace svdag {

struct Run {
  HugeVector<Brick> bricks;
  std::vector<HugeVector<NodeKey>> nodes;  // [level], 0 .. L-3
};

// The permutation from provisional numbers to ranks, per level (the last entry is the brick level).
using Ranks = std::vector<HugeVector<uint32_t>>;

// Empties `table` and sorts it, level by level from the bricks up. *ranks tells what became of the
// provisional numbers.
Run freeze(NodeTable* table, Ranks* ranks);

}  // namespace svdag
