// The cells of side S = 2^shift lattice steps that a closed box touches: on each axis those for
// which the closed interval [k, k+1] * S meets [low, high].
//
// An end on a cell plane touches both neighbours. All voxels that a triangle sets are in the
// touched cells of its box, so judges test no others. Builder and judge share no formula, so this
// one is the judge's own; tests/verify/judge/touched_cells_test.cpp compares it with the
// definition, cell by cell.
#pragma once

#include "io/grid.h"

namespace svdag {

// The first k with low <= (k+1) * S.
inline int64_t first_touched_cell(int64_t low, int shift) {
  return -((-low) >> shift) - 1;
}

// The last k with k * S <= high.
inline int64_t last_touched_cell(int64_t high, int shift) {
  return high >> shift;
}

// The touched cells inside `window` (in cells); may be empty.
inline VoxelBox touched_cells(const LatticeBox& box, int shift, const VoxelBox& window) {
  VoxelBox cells;
  for (int a = 0; a < 3; ++a) {
    cells.min[a] = std::max(window.min[a], first_touched_cell(box.min[a], shift));
    cells.max[a] = std::min(window.max[a], last_touched_cell(box.max[a], shift) + 1);
  }
  return cells;
}

}  // namespace svdag
