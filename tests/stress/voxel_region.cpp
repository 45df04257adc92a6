#include "tests/stress/voxel_region.h"

#include <algorithm>
#include <bit>

#include "streaming/error.h"

namespace svdag {

VoxelRegion::VoxelRegion(const VoxelBox& box) : box_(box) {
  const LatticePoint side = box.max - box.min;
  for (int a = 0; a < 3; ++a) SVDAG_ASSERT(side[a] >= 1 && side[a] <= 64);
  full_row_ = ~uint64_t(0) >> (64 - side.z);
  rows_.resize(size_t(side.x * side.y));
}

bool VoxelRegion::contains(const LatticePoint& voxel) const {
  for (int a = 0; a < 3; ++a) {
    if (voxel[a] < box_.min[a] || voxel[a] >= box_.max[a]) return false;
  }
  return true;
}

uint64_t VoxelRegion::set_brick(const LatticePoint& coordinate, Brick brick) {
  uint64_t outside = 0;
  for (Brick left = brick; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const LatticePoint in_brick{(bit >> 5 & 1) * 2 + (bit >> 2 & 1),
                                (bit >> 4 & 1) * 2 + (bit >> 1 & 1),
                                (bit >> 3 & 1) * 2 + (bit & 1)};
    const LatticePoint voxel = coordinate * int64_t(kBrickSide) + in_brick;
    if (contains(voxel)) {
      set(voxel);
    } else {
      ++outside;
    }
  }
  return outside;
}

uint64_t VoxelRegion::count() const {
  uint64_t voxels = 0;
  for (const uint64_t r : rows_) voxels += uint64_t(std::popcount(r));
  return voxels;
}

uint64_t VoxelRegion::count_without(const VoxelRegion& other) const {
  SVDAG_ASSERT(box_ == other.box_);
  uint64_t voxels = 0;
  for (size_t i = 0; i < rows_.size(); ++i)
    voxels += uint64_t(std::popcount(rows_[i] & ~other.rows_[i]));
  return voxels;
}

VoxelRegion VoxelRegion::dilated() const {
  VoxelRegion result(box_);
  for (int64_t x = box_.min.x; x < box_.max.x; ++x) {
    for (int64_t y = box_.min.y; y < box_.max.y; ++y) {
      const uint64_t r = row(x, y);
      const uint64_t wide = (r | r << 1 | r >> 1) & full_row_;
      if (wide == 0) continue;
      for (int64_t i = std::max(box_.min.x, x - 1); i <= std::min(box_.max.x - 1, x + 1); ++i) {
        for (int64_t j = std::max(box_.min.y, y - 1); j <= std::min(box_.max.y - 1, y + 1); ++j)
          result.row(i, j) |= wide;
      }
    }
  }
  return result;
}

VoxelRegion VoxelRegion::dilated_by_faces() const {
  VoxelRegion result(box_);
  for (int64_t x = box_.min.x; x < box_.max.x; ++x) {
    for (int64_t y = box_.min.y; y < box_.max.y; ++y) {
      const uint64_t r = row(x, y);
      result.row(x, y) |= (r | r << 1 | r >> 1) & full_row_;
      if (x > box_.min.x) result.row(x - 1, y) |= r;
      if (x + 1 < box_.max.x) result.row(x + 1, y) |= r;
      if (y > box_.min.y) result.row(x, y - 1) |= r;
      if (y + 1 < box_.max.y) result.row(x, y + 1) |= r;
    }
  }
  return result;
}

}  // namespace svdag
