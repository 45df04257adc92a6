// The cells that judges look at: those that a closed box touches, and their Morton codes.
//
// Builder and judge share no formula, so these are the judge's own; tests/verify/judge/
// judge_cells_test.cpp compares the touched cells with their definition, cell by cell.
#pragma once

#include <cstdint>

#include "io/grid.h"
#include "io/triangle.h"

namespace svdag {

// The cells of side S = 2^shift lattice steps that a closed box touches: on each axis those for
// which the closed interval [k, k+1] * S meets [low, high]. An end on a cell plane touches both
// neighbours. All voxels that a triangle sets are in the touched cells of its box, so judges test
// no others.

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

// Morton codes of the cells of one level: numbers in the order of a depth-first walk.
//
// The bits of x, y, z are interleaved, x first, so each three bits are a child number 4x + 2y + z
// and the code of the parent is code >> 3. Coordinates have at most 20 bits.
inline uint64_t cell_code(const LatticePoint& cell) {
  const auto spread = [](uint64_t v) {  // puts two zeros between the bits
    v = (v | v << 32) & 0x001f00000000ffffULL;
    v = (v | v << 16) & 0x001f0000ff0000ffULL;
    v = (v | v << 8) & 0x100f00f00f00f00fULL;
    v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
    return (v | v << 2) & 0x1249249249249249ULL;
  };
  return spread(uint64_t(cell.x)) << 2 | spread(uint64_t(cell.y)) << 1 | spread(uint64_t(cell.z));
}

inline LatticePoint cell_of_code(uint64_t code) {
  const auto gather = [](uint64_t v) {
    v &= 0x1249249249249249ULL;
    v = (v | v >> 2) & 0x10c30c30c30c30c3ULL;
    v = (v | v >> 4) & 0x100f00f00f00f00fULL;
    v = (v | v >> 8) & 0x001f0000ff0000ffULL;
    v = (v | v >> 16) & 0x001f00000000ffffULL;
    return int64_t((v | v >> 32) & 0x1fffffULL);
  };
  return {gather(code >> 2), gather(code >> 1), gather(code)};
}

}  // namespace svdag
