// Conversion between our child numbers, c = 4x + 2y + z, and those of formats with
// t = x + 2y + 4z.
#pragma once

#include "io/brick.h"

namespace svdag {

// c to t, or t to c.
constexpr unsigned mirrored_child(unsigned c) {
  return (c >> 2 & 1) | (c & 2) | (c << 2 & 4);
}

// The brick with both child numbers of each bit mirrored: 4^3 voxels in Morton order, x in the
// lowest bit.
constexpr Brick mirrored_brick(Brick brick) {
  Brick mirrored = 0;
  for (unsigned c1 = 0; c1 < 8; ++c1) {
    const unsigned block = unsigned(brick >> (8 * c1) & 0xff);
    unsigned out = 0;
    for (unsigned c2 = 0; c2 < 8; ++c2) out |= (block >> c2 & 1) << mirrored_child(c2);
    mirrored |= Brick(out) << (8 * mirrored_child(c1));
  }
  return mirrored;
}

}  // namespace svdag
