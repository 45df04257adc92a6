// Cuts the Morton order of cells into contiguous ranges of about equal work.
#pragma once

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

}  // namespace svdag
