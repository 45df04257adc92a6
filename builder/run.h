// A run: the reduced levels of some cells, sorted, with every child inside the run.
//
// Invariant (closed and canonical): children are 1 + ranks in the run's own next level; each level
// is strictly ascending by NodeKey (bricks as numbers). Runs of different workers therefore agree
// on the order of the nodes they share, which is all that the merge needs.
#pragma once

#include <span>
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

// A node of a table by level and number.
struct NodeNumber {
  int level;
  uint32_t number;
};

// Empties `table` and sorts what `roots` reach, level by level from the bricks up. The rest goes: the
// plane memo (builder/plane_memo.h) adds nodes to answers that it then takes back. *ranks tells
// what became of the numbers of the nodes that stay.
Run freeze(NodeTable* table, std::span<const NodeNumber> roots, Ranks* ranks);

}  // namespace svdag
