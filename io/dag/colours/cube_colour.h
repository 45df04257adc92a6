// The colour of one covered cube, or of all covered cubes of a node, before encoding: what the
// colour pass gives to the writer of a file.
//
// Entries ascend, depth first, so in Morton order. Every covered cube of the colour level K is in
// exactly one: alone, or as a descendant of an entry of a smaller level.
#pragma once

#include <cstdint>

namespace svdag {

struct CubeColour {
  uint64_t morton;     // of the cube among those of its level: x highest, child c = 4x + 2y + z
  uint8_t level;       // K, or less for a node whose triangles all have one constant colour
  bool has_colour;     // false: a full node of a solid that no triangle touches
  bool is_constant;    // all triangles that meet the cube have the same constant colour
  uint16_t linear[3];  // linear light, 0 .. 65535
};

}  // namespace svdag
