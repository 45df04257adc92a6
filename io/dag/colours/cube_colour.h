// The colour of one covered cube, or of all covered cubes of a node, before it is encoded: what the
// pass over a scene passes to the writer of a file.
//
// Cubes come in ascending order, depth first, so in Morton order. Every covered cube of the colour
// level K is in exactly one entry: alone, or as a descendant of an entry of a smaller level. The
// writer finds maximal uniform nodes itself, so the file does not depend on how coarse the entries
// are.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

namespace svdag {

struct CubeColour {
  uint64_t morton;     // of the cube among those of its level (x highest, child c = 4x + 2y + z)
  uint8_t level;       // K, or less for a node whose triangles all have one constant colour
  bool has_colour;     // false: a full node of a solid that no triangle touches
  bool is_constant;    // all triangles that meet the cube have the same constant colour
  uint16_t linear[3];  // linear light, 0 .. 65535
};

using CubeColourSink = std::function<void(std::span<const CubeColour>)>;

}  // namespace svdag
