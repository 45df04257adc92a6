// Voxel cubes, the unit of exchange with foreign voxel formats: a block of 8^3 voxels, or a larger
// full cube.
//
// A block is eight u64; voxel (x, y, z), each 0 .. 7, is bit 8y + z of word x. Leaves of OpenVDB
// and NanoVDB have the same layout, so blocks are copied unchanged.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <functional>

#include "io/brick.h"
#include "io/grid.h"

namespace svdag {

constexpr int64_t kBlockSide = 8;

struct Block {
  std::array<uint64_t, 8> words{};

  static Block full() {
    Block block;
    block.words.fill(~uint64_t(0));
    return block;
  }
  bool get(unsigned x, unsigned y, unsigned z) const { return words[x] >> (8 * y + z) & 1; }
  void set(unsigned x, unsigned y, unsigned z) { words[x] |= uint64_t(1) << (8 * y + z); }
  // Adds a brick to the octant whose corner is (x, y, z), each 0 or 4.
  void set_brick(unsigned x, unsigned y, unsigned z, Brick brick) {
    for (; brick != 0; brick &= brick - 1) {
      const auto [bx, by, bz] = brick_voxel(unsigned(std::countr_zero(brick)));
      set(x + bx, y + by, z + bz);
    }
  }
  // Clears the voxels outside `box`; the block's corner is `origin`.
  void cut(const LatticePoint& origin, const VoxelBox& box) {
    LatticePoint low, high;
    for (int a = 0; a < 3; ++a) {
      low[a] = std::clamp<int64_t>(box.min[a] - origin[a], 0, kBlockSide);
      high[a] = std::clamp<int64_t>(box.max[a] - origin[a], low[a], kBlockSide);
    }
    const uint64_t row = (uint64_t(1) << high.z) - (uint64_t(1) << low.z);
    uint64_t plane = 0;
    for (int64_t y = low.y; y < high.y; ++y) plane |= row << (8 * y);
    for (int64_t x = 0; x < kBlockSide; ++x)
      words[size_t(x)] &= x >= low.x && x < high.x ? plane : 0;
  }
  uint64_t count() const {
    uint64_t sum = 0;
    for (const uint64_t word : words) sum += uint64_t(std::popcount(word));
    return sum;
  }
  bool empty() const { return count() == 0; }
  Block operator&(const Block& other) const {
    return with(other, [](auto a, auto b) { return a & b; });
  }
  Block without(const Block& other) const {
    return with(other, [](auto a, auto b) { return a & ~b; });
  }
  bool operator==(const Block&) const = default;

 private:
  template <class Combine>
  Block with(const Block& other, Combine combine) const {
    Block result;
    for (size_t x = 0; x < 8; ++x) result.words[x] = combine(words[x], other.words[x]);
    return result;
  }
};

// Voxels origin .. origin + side - 1 on each axis. Side 8: the voxels of `block`; larger: all set.
struct VoxelCube {
  LatticePoint origin{0};
  int64_t side = kBlockSide;
  Block block;

  VoxelBox box() const { return {origin, origin + side}; }
  uint64_t count() const {
    return side == kBlockSide ? block.count() : uint64_t(side) * uint64_t(side) * uint64_t(side);
  }
};

// Divides a full cube into those whose voxels have one value: calls visit(cube, value) for these,
// and visit(block, none) for blocks of several values, and for one that is not full. Stops when it
// returns false. `value_of`: the value of a full cube, or none.
template <class ValueOf, class Visit>
bool divide_by_value(const VoxelCube& cube, const ValueOf& value_of, const Visit& visit) {
  const bool is_block = cube.side == kBlockSide;
  const auto value =
      is_block && cube.block != Block::full() ? decltype(value_of(cube))() : value_of(cube);
  if (value || is_block) return visit(cube, value);
  for (unsigned c = 0; c < 8; ++c) {
    const LatticePoint half(c >> 2 & 1, c >> 1 & 1, c & 1);
    const VoxelCube part{cube.origin + half * (cube.side / 2), cube.side / 2, Block::full()};
    if (!divide_by_value(part, value_of, visit)) return false;
  }
  return true;
}

// Receives cubes one by one; returns false to stop.
using VoxelCubeSink = std::function<bool(const VoxelCube&)>;

}  // namespace svdag
