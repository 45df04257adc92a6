#include "builder/commands/import/vdb.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The placement of a grid whose voxel (0, 0, 0) is voxel `first` of the index space.
GridPlacement placement_of(const std::string& path, const IndexToWorld& centres,
                           const LatticePoint& first) {
  GridPlacement place;
  place.voxel_size = centres.axes[0].x;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double expected = a == b ? place.voxel_size : 0;
      if (std::abs(centres.axes[size_t(a)][b] - expected) > 1e-6 * std::abs(place.voxel_size))
        fail_input(path,
                   "the grid's transform rotates, mirrors or stretches it, which is not supported");
    }
  }
  place.corner = centres(Point(first)) - place.voxel_size * 0.5;
  return place;
}

bool is_full(const VoxelCube& cube) {
  return cube.side > kBlockSide || cube.block == Block::full();
}

// Adds the voxels of a block, relative to `first`.
void add_block(const VoxelCube& cube, const LatticePoint& first, VoxelBatch* batch) {
  const LatticePoint at = cube.origin - first;
  for (int64_t x = 0; x < kBlockSide; ++x)
    for (int64_t y = 0; y < kBlockSide; ++y)
      for (int64_t z = 0; z < kBlockSide; ++z) {
        if (cube.block.get(unsigned(x), unsigned(y), unsigned(z)))
          batch->add({uint32_t(at.x + x), uint32_t(at.y + y), uint32_t(at.z + z)});
      }
}

}  // namespace

VdbVoxels::VdbVoxels(std::unique_ptr<VdbGrid> grid, const std::string& path)
    : grid_(std::move(grid)) {
  int64_t max_side = kBlockSide;  // of the cubes
  grid_->visit([&](const VoxelCube& cube) {
    max_side = std::max(max_side, cube.side);
    if (!is_full(cube)) count_ += cube.count();
    return true;
  });
  const VoxelBox box = grid_->bounds();
  for (int a = 0; a < 3 && !box.empty(); ++a) {
    // A multiple of the side of every cube, so that cubes stay aligned.
    if (box.min[a] < 0 || box.max[a] > int64_t(1) << kMaxLevels)
      first_[a] = box.min[a] & ~(max_side - 1);
    if (box.max[a] - first_[a] > int64_t(1) << kMaxLevels)
      fail_input(path, "the voxels of the grid span more than 1M (1,048,576) on an axis");
  }
  place_ = placement_of(path, grid_->centres(), first_);
}

GridPlacement VdbVoxels::read(const VoxelSink& voxels, const FullCubeSink& cubes) const {
  VoxelBatch batch(voxels);
  grid_->visit([&](const VoxelCube& cube) {
    check_interrupt();
    const LatticePoint at = cube.origin - first_;
    if (is_full(cube))
      cubes({{uint32_t(at.x), uint32_t(at.y), uint32_t(at.z)},
             std::countr_zero(uint64_t(cube.side))});
    else
      add_block(cube, first_, &batch);
    return true;
  });
  batch.flush();
  return place_;
}

}  // namespace svdag
