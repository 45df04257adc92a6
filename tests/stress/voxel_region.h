// The voxels of a box of at most 64^3 voxels as bits, so that two results are compared a row of 64
// voxels at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "io/brick.h"
#include "io/grid.h"

namespace svdag {

class VoxelRegion {
 public:
  // Begins with every voxel of `box` (sides 1 .. 64) clear.
  explicit VoxelRegion(const VoxelBox& box);

  const VoxelBox& box() const { return box_; }
  bool contains(const LatticePoint& voxel) const;
  bool test(const LatticePoint& voxel) const {
    return (row(voxel.x, voxel.y) >> (voxel.z - box_.min.z) & 1) != 0;
  }
  void set(const LatticePoint& voxel) {
    row(voxel.x, voxel.y) |= uint64_t(1) << (voxel.z - box_.min.z);
  }
  // Sets the voxels of a brick (at `coordinate`, in bricks) that are in the box; returns the number
  // of those that are outside.
  uint64_t set_brick(const LatticePoint& coordinate, Brick brick);

  uint64_t count() const;
  // Number of voxels of this region that are clear in `other`, which has the same box.
  uint64_t count_without(const VoxelRegion& other) const;
  // These voxels and their 26 neighbours, within the box.
  VoxelRegion dilated() const;
  // These voxels and their 6 neighbours, within the box.
  VoxelRegion dilated_by_faces() const;

  // The bits of the voxels (x, y, box.min.z + i), i the bit; x and y in the box.
  uint64_t row(int64_t x, int64_t y) const { return rows_[index(x, y)]; }
  uint64_t& row(int64_t x, int64_t y) { return rows_[index(x, y)]; }
  uint64_t full_row() const { return full_row_; }
  bool operator==(const VoxelRegion&) const = default;

 private:
  size_t index(int64_t x, int64_t y) const {
    return size_t((x - box_.min.x) * (box_.max.y - box_.min.y) + (y - box_.min.y));
  }

  VoxelBox box_;
  uint64_t full_row_;
  std::vector<uint64_t> rows_;
};

}  // namespace svdag
