// Morton codes: the order of voxels and cubes in which every octree cube is one range.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "builder/octree/octree_cube.h"

namespace svdag {

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

// Voxels begin <= code < end in Morton order.
struct MortonRange {
  uint64_t begin = 0, end = 0;
  bool operator==(const MortonRange&) const = default;
};

inline MortonRange morton_range(const Cube& cube, int levels) noexcept {
  const int shift = 3 * (levels - cube.level);
  const uint64_t code = morton(cube.coordinate);
  return {code << shift, (code + 1) << shift};
}

// The cube of which `range` holds the voxels.
inline Cube cube_of(const MortonRange& range, int levels) noexcept {
  int level = levels;
  while (range.end - range.begin > uint64_t(1) << 3 * (levels - level)) --level;
  return {level, unmorton(range.begin >> 3 * (levels - level))};
}

// Calls visit(cube) for the largest cubes that `range` consists of, in Morton order.
template <class Visit>
void for_each_cube(const MortonRange& range, int levels, const Visit& visit) {
  for (uint64_t at = range.begin; at < range.end;) {
    int log2 = at == 0 ? levels : std::min(levels, std::countr_zero(at) / 3);
    while (uint64_t(1) << 3 * log2 > range.end - at) --log2;
    visit(Cube{levels - log2, unmorton(at >> 3 * log2)});
    at += uint64_t(1) << 3 * log2;
  }
}

// Appends `range`, joined to the last range if it begins where that ends.
inline void append_range(std::vector<MortonRange>* ranges, const MortonRange& range) {
  if (range.begin == range.end) return;
  if (!ranges->empty() && ranges->back().end == range.begin) {
    ranges->back().end = range.end;
  } else {
    ranges->push_back(range);
  }
}

}  // namespace svdag
