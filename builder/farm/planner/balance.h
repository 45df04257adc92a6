// Divides the work of a plan evenly: the Morton order of cells into contiguous ranges of about
// equal work, and the merges into a tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "builder/octree/grid_part.h"

namespace svdag {

// A non-empty cell and its cost.
struct CellCost {
  uint64_t cell = 0;  // Morton code
  double cost = 0;
};

// Returns `count` consecutive ranges that cover all cells of `level`. `cells` must be sorted. Each
// boundary is the one nearest to its target cost, so the cost of a range is off by less than its
// two outermost cells. A range may be empty where one cell costs more than a whole share.
std::vector<CellRange> cut_evenly(const std::vector<CellCost>& cells, int level, size_t count);

// The merge tree of a plan: each merge reads neighbouring runs and writes one contiguous grid part.
// The inputs of each merge, by number: 0 .. leaves-1 are the leaves; then come the merges in list
// order. The last merge is the root.
using MergeTree = std::vector<std::vector<size_t>>;

// As even as possible, with at most `fan_in` (>= 2) inputs per merge and at least one merge.
MergeTree merge_tree(size_t leaves, size_t fan_in);

}  // namespace svdag
