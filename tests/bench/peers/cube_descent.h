// The octree descent of every peer method: from a cell to its voxels by a test of one triangle
// against one cube.
//
// A Predicate has a type Setup (one triangle, prepared once per cell) and
//   bool operator()(const Setup&, const LatticePoint& corner, int64_t side) const
// with corner and side in voxels. A cube keeps the triangles that touch it; a child tests those of
// its parent; a voxel stops at the first hit. All methods get the same lists and write the same
// kind of output, so time per pair compares the tests and the pruning that they allow.
#pragma once

#include <span>
#include <vector>

#include "builder/octree/morton.h"
#include "io/brick.h"

namespace svdag::bench {

// The bricks of a set of voxels, in Morton order, without empty ones.
struct BrickAt {
  uint64_t code;
  Brick voxels;
  bool operator==(const BrickAt&) const = default;
};
using BrickList = std::vector<BrickAt>;

template <class Predicate>
class CubeDescent {
 public:
  using Setup = typename Predicate::Setup;

  CubeDescent(const Predicate& predicate, std::span<const Setup> setups)
      : touches_(predicate), setups_(setups), lists_(kDepth) {}

  // Appends the bricks of the cube of 2^log2 >= 4 voxels a side at `corner`.
  void run(const LatticePoint& corner, int log2, BrickList* out) {
    out_ = out;
    std::vector<uint32_t>& list = lists_[size_t(log2)];
    list.clear();
    for (uint32_t i = 0; i < setups_.size(); ++i) {
      if (touches_(setups_[i], corner, int64_t(1) << log2)) list.push_back(i);
    }
    if (!list.empty()) descend(corner, log2);
  }

 private:
  static constexpr size_t kDepth = kMaxLevels + 1;

  static LatticePoint child_corner(const LatticePoint& corner, unsigned c, int64_t side) {
    return {corner.x + (c & 4 ? side : 0), corner.y + (c & 2 ? side : 0),
            corner.z + (c & 1 ? side : 0)};
  }

  void descend(const LatticePoint& corner, int log2) {
    if (log2 == 2) brick_ = 0;
    const std::vector<uint32_t>& list = lists_[size_t(log2)];
    std::vector<uint32_t>& below = lists_[size_t(log2 - 1)];
    const int64_t side = int64_t(1) << (log2 - 1);
    for (unsigned c = 0; c < 8; ++c) {
      const LatticePoint at = child_corner(corner, c, side);
      if (log2 == 1) {
        if (any(list, at)) brick_ |= Brick(1) << brick_bit(at.x & 3, at.y & 3, at.z & 3);
        continue;
      }
      below.clear();
      for (const uint32_t i : list) {
        if (touches_(setups_[i], at, side)) below.push_back(i);
      }
      if (!below.empty()) descend(at, log2 - 1);
    }
    if (log2 == 2 && brick_ != 0) out_->push_back({morton(corner / int64_t(kBrickSide)), brick_});
  }

  bool any(const std::vector<uint32_t>& list, const LatticePoint& voxel) const {
    for (const uint32_t i : list) {
      if (touches_(setups_[i], voxel, 1)) return true;
    }
    return false;
  }

  Predicate touches_;
  std::span<const Setup> setups_;
  std::vector<std::vector<uint32_t>> lists_;  // by log2 of the cube's side, reused
  Brick brick_ = 0;
  BrickList* out_ = nullptr;
};

}  // namespace svdag::bench
