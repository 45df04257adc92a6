// Morton codes of the cells of one level: numbers in the order of a depth-first walk.
//
// The bits of x, y, z are interleaved, x first, so each three bits are a child number 4x + 2y + z
// and the code of the parent is code >> 3. Coordinates have at most 20 bits.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag {

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
