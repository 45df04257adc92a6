// Cubes of the octree, and the lists that go down it.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/triangle_setup.h"
#include "io/grid.h"

namespace svdag {

// The cube of octree level `level` at `coordinate` (in units of its own side, 0 .. 2^level - 1).
struct Cube {
  int level = 0;
  LatticePoint coordinate{0};

  Cube child(unsigned c) const noexcept {
    return {level + 1,
            {2 * coordinate.x + (c >> 2 & 1), 2 * coordinate.y + (c >> 1 & 1),
             2 * coordinate.z + (c & 1)}};
  }
  // log2 of the side in lattice units, of a grid with `levels` levels.
  int side_log2(int levels) const noexcept { return levels - level + fraction_bits(levels); }
  // The minimum corner in lattice units.
  LatticePoint corner(int levels) const noexcept {
    const int shift = side_log2(levels);
    return {coordinate.x << shift, coordinate.y << shift, coordinate.z << shift};
  }
  bool operator==(const Cube&) const = default;
};

// The cube of `level` <= cube.level in which `cube` lies.
inline Cube ancestor(const Cube& cube, int level) noexcept {
  const int up = cube.level - level;
  return {level, {cube.coordinate.x >> up, cube.coordinate.y >> up, cube.coordinate.z >> up}};
}

// One triangle in the list of a cube that it (very likely) touches, with the edge functions that do
// not yet hold everywhere in the cube. An edge that holds in a cube holds in all its parts, so it
// is switched off for good.
struct Entry {
  const TriangleSetup* triangle;
  EdgeMask edges;
};
using EntryList = std::vector<Entry>;

// Interleaves the low 21 bits of x, y, z: x above y above z, so that children of one cube are
// consecutive and the lowest three bits are the child number.
constexpr uint64_t morton(const LatticePoint& p) noexcept {
  const auto spread = [](uint64_t v) {
    v &= 0x1fffff;
    v = (v | v << 32) & 0x1f00000000ffff;
    v = (v | v << 16) & 0x1f0000ff0000ff;
    v = (v | v << 8) & 0x100f00f00f00f00f;
    v = (v | v << 4) & 0x10c30c30c30c30c3;
    return (v | v << 2) & 0x1249249249249249;
  };
  return spread(uint64_t(p.x)) << 2 | spread(uint64_t(p.y)) << 1 | spread(uint64_t(p.z));
}

// The point whose code is `code`.
constexpr LatticePoint unmorton(uint64_t code) noexcept {
  LatticePoint p(0);
  for (int bit = 0; bit < 21; ++bit) {
    for (int a = 0; a < 3; ++a) p[a] |= int64_t(code >> (3 * bit + 2 - a) & 1) << bit;
  }
  return p;
}

}  // namespace svdag
