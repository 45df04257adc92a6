// Masks of a brick's slabs and the coordinates of its bits.
#pragma once

#include <array>
#include <cstdint>

#include "io/brick.h"

namespace svdag {

struct BrickTables {
  std::array<std::array<Brick, 4>, 3> slab{};           // [axis][i]: voxels with coordinate i
  std::array<std::array<uint8_t, 3>, 64> coordinate{};  // of each bit
  // [w][i][m]: voxels with coordinate i on axis w+1 and, on axis w+2, one of the coordinates in m
  std::array<std::array<std::array<Brick, 16>, 4>, 3> columns{};
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
        t.coordinate[bit] = {uint8_t(x), uint8_t(y), uint8_t(z)};
      }
    }
  }
  for (unsigned w = 0; w < 3; ++w) {
    for (unsigned i = 0; i < 4; ++i) {
      for (unsigned m = 0; m < 16; ++m) {
        for (unsigned j = 0; j < 4; ++j) {
          if (m >> j & 1) t.columns[w][i][m] |= t.slab[(w + 1) % 3][i] & t.slab[(w + 2) % 3][j];
        }
      }
    }
  }
  return t;
}

inline constexpr BrickTables kBrickTables = make_brick_tables();

// The voxels whose column along w is in `columns`, bit 4i + j for coordinate i on axis w+1, j on
// w+2.
constexpr Brick expand_columns(int w, unsigned columns) {
  const auto& table = kBrickTables.columns[size_t(w)];
  return table[0][columns & 15] | table[1][columns >> 4 & 15] | table[2][columns >> 8 & 15] |
         table[3][columns >> 12];
}

}  // namespace svdag
