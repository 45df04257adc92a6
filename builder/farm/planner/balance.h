// Cuts the Morton order of cells into contiguous ranges of about equal work.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/octree/grid_part.h"

namespace svdag {

// A cell that is not empty, and what it costs.
struct CellCost {
  uint64_t cell = 0;  // Morton code
  double cost = 0;
};

// `count` ranges that hold all cells of `level` together, in order. `cells` ascend. Each boundary
// is the one nearest to its share, so a range is off by less than its two outermost cells. A range
// may be empty where one cell is dearer than a whole share.
std::vector<CellRange> cut_evenly(const std::vector<CellCost>& cells, int level, size_t count);

}  // namespace svdag
