// A brick: 4x4x4 voxels in one u64.
//
// Children of a node and voxels of a 2x2x2 block are numbered c = 4x + 2y + z. Bit 8*c1 + c2 of a
// brick is the voxel in child c1 of the outer and child c2 of the inner 2x2x2. HashDAG and SymVox
// use the same layout, so bricks are exported unchanged.
#pragma once

#include <array>
#include <cstdint>

namespace svdag {

using Brick = uint64_t;

constexpr int kBrickSide = 4;

// The number of the child of a cube at (x, y, z), each 0 or 1.
constexpr unsigned child_index(unsigned x, unsigned y, unsigned z) {
  return 4 * x + 2 * y + z;
}

// The bit of voxel (x, y, z), each in 0 .. 3, of a brick.
constexpr unsigned brick_bit(unsigned x, unsigned y, unsigned z) {
  return 8 * child_index(x >> 1, y >> 1, z >> 1) + child_index(x & 1, y & 1, z & 1);
}

// The voxel (x, y, z) of bit `bit`.
constexpr std::array<unsigned, 3> brick_voxel(unsigned bit) {
  return {(bit >> 4 & 2) | (bit >> 2 & 1), (bit >> 3 & 2) | (bit >> 1 & 1),
          (bit >> 2 & 2) | (bit & 1)};
}

}  // namespace svdag
