// A cube of the octree: its level and coordinate.
#pragma once

#include "io/brick.h"
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
  // The cube is child(index_in_parent()) of its parent.
  unsigned index_in_parent() const noexcept {
    return child_index(unsigned(coordinate.x & 1), unsigned(coordinate.y & 1),
                       unsigned(coordinate.z & 1));
  }
  // log2 of the side in lattice units, of a grid with `levels` levels.
  int side_log2(int levels) const noexcept { return levels - level + fraction_bits(levels); }
  // The minimum corner in lattice units.
  LatticePoint corner(int levels) const noexcept {
    const int shift = side_log2(levels);
    return {coordinate.x << shift, coordinate.y << shift, coordinate.z << shift};
  }
  // The closed cube in lattice units.
  LatticeBox closed(int levels) const noexcept {
    const LatticePoint min = corner(levels);
    return {min, min + (int64_t(1) << side_log2(levels))};
  }
  // The voxels of the cube.
  VoxelBox voxels(int levels) const noexcept {
    const int shift = levels - level;
    const LatticePoint min = {coordinate.x << shift, coordinate.y << shift, coordinate.z << shift};
    return {min, min + (int64_t(1) << shift)};
  }
  bool operator==(const Cube&) const = default;
};

// The cube of `level` <= cube.level that contains `cube`.
inline Cube ancestor(const Cube& cube, int level) noexcept {
  const int up = cube.level - level;
  return {level, {cube.coordinate.x >> up, cube.coordinate.y >> up, cube.coordinate.z >> up}};
}

}  // namespace svdag
