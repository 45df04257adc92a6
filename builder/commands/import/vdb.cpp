#include "builder/commands/import/vdb.h"

#include <cmath>

#include "streaming/error.h"
#include "streaming/interrupt.h"

namespace svdag {
namespace {

// Where voxel `first` of index space has its corner, and how large voxels are.
VoxelPlace place_of(const std::string& path, const IndexToWorld& centres,
                    const LatticePoint& first) {
  VoxelPlace place;
  place.voxel_size = centres.axes[0].x;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) {
      const double expected = a == b ? place.voxel_size : 0;
      if (std::abs(centres.axes[size_t(a)][b] - expected) > 1e-6 * std::abs(place.voxel_size))
        fail_input(path, "its transform turns, mirrors or stretches the grid, which is not read");
    }
  }
  place.corner = centres(Point(first)) - place.voxel_size * 0.5;
  return place;
}

// The voxels of a cube, from `first` on.
void add_cube(const Cube& cube, const LatticePoint& first, VoxelBatch* batch) {
  const LatticePoint at = cube.origin - first;
  for (int64_t x = 0; x < cube.side; ++x)
    for (int64_t y = 0; y < cube.side; ++y)
      for (int64_t z = 0; z < cube.side; ++z) {
        if (cube.side == kBlockSide && !cube.block.get(unsigned(x), unsigned(y), unsigned(z)))
          continue;
        batch->add({uint32_t(at.x + x), uint32_t(at.y + y), uint32_t(at.z + z)});
      }
}

}  // namespace

VdbVoxels::VdbVoxels(const std::string& path, const std::string& name, bool sandbox)
    : grid_(read_vdb(path, name, {}, sandbox)) {
  const VoxelBox box = grid_->bounds();
  for (int a = 0; a < 3 && !box.empty(); ++a) {
    // A multiple of 8, so that blocks stay blocks.
    if (box.min[a] < 0 || box.max[a] > int64_t(1) << kMaxLevels)
      first_[a] = box.min[a] & ~(kBlockSide - 1);
    if (box.max[a] - first_[a] > int64_t(1) << kMaxLevels)
      fail_input(path, "its voxels span more than 1M on an axis");
  }
  grid_->visit([&](const Cube& cube) {
    count_ += cube.count();  // 2^60 at most, since no two cubes overlap
    return true;
  });
  place_ = place_of(path, grid_->centres(), first_);
}

VoxelPlace VdbVoxels::read(const VoxelSink& sink) const {
  VoxelBatch batch(sink);
  grid_->visit([&](const Cube& cube) {
    check_interrupt();
    add_cube(cube, first_, &batch);
    return true;
  });
  batch.flush();
  return place_;
}

}  // namespace svdag
