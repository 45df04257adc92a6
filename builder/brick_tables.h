// Masks of a brick's slabs and the coordinates of its bits.
#pragma once

#include <array>
#include <cstdint>

#include "io/brick.h"

namespace svdag {

struct BrickTables {
  std::array<std::array<Brick, 4>, 3> slab{};           // [axis][i]: voxels with coordinate i
  std::array<std::array<uint8_t, 3>, 64> coordinate{};  // of each bit
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
  return t;
}

inline constexpr BrickTables kBrickTables = make_brick_tables();

}  // namespace svdag
