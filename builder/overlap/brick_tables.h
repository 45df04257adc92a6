// Constant tables of a brick: masks of its slabs and columns, coordinates of its bits.
#pragma once

#include <cstdint>

#include "io/brick.h"

namespace svdag {

// Plain arrays, since the code of the vector kernels must not instantiate templates.
struct BrickTables {
  Brick slab[3][4]{};           // [axis][i]: voxels with coordinate i
  Brick slabs[3][16]{};         // [axis][m]: voxels with one of the coordinates in m
  uint8_t coordinate[64][3]{};  // of each bit
  Brick columns[3][4][16]{};    // [w][i][m]: voxels with coordinate i on axis w+1 and, on axis
                                // w+2, one of the coordinates in m
};

constexpr BrickTables make_brick_tables() {
  BrickTables t;
  for (unsigned x = 0; x < 4; ++x) {
    for (unsigned y = 0; y < 4; ++y) {
      for (unsigned z = 0; z < 4; ++z) {
        const unsigned bit = brick_bit(x, y, z);
        t.slab[0][x] |= Brick(1) << bit;
        t.slab[1][y] |= Brick(1) << bit;
        t.slab[2][z] |= Brick(1) << bit;
        t.coordinate[bit][0] = uint8_t(x);
        t.coordinate[bit][1] = uint8_t(y);
        t.coordinate[bit][2] = uint8_t(z);
      }
    }
  }
  for (unsigned w = 0; w < 3; ++w) {
    for (unsigned i = 0; i < 4; ++i) {
      for (unsigned m = 0; m < 16; ++m) {
        if (m >> i & 1) t.slabs[w][m] |= t.slab[w][i];
        for (unsigned j = 0; j < 4; ++j) {
          if (m >> j & 1) t.columns[w][i][m] |= t.slab[(w + 1) % 3][i] & t.slab[(w + 2) % 3][j];
        }
      }
    }
  }
  return t;
}

inline constexpr BrickTables kBrickTables = make_brick_tables();

// The voxels whose column along w is in `columns`: bit 4i + j is the column at coordinate i on axis
// w+1 and j on axis w+2.
constexpr Brick expand_columns(int w, unsigned columns) {
  const auto& table = kBrickTables.columns[w];
  return table[0][columns & 15] | table[1][columns >> 4 & 15] | table[2][columns >> 8 & 15] |
         table[3][columns >> 12];
}

}  // namespace svdag
