#include "builder/commands/import/vdb.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "io/formats/vdb.h"
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

// A cube, in voxels from `first` on.
void add_cube(const Cube& cube, const LatticePoint& first, VoxelBatch* batch,
              const FullCubeSink& cubes) {
  const LatticePoint at = cube.origin - first;
  if (cube.side > kBlockSide || cube.block == Block::full())
    return cubes(
        {{uint32_t(at.x), uint32_t(at.y), uint32_t(at.z)}, std::countr_zero(uint64_t(cube.side))});
  for (int64_t x = 0; x < cube.side; ++x)
    for (int64_t y = 0; y < cube.side; ++y)
      for (int64_t z = 0; z < cube.side; ++z) {
        if (!cube.block.get(unsigned(x), unsigned(y), unsigned(z))) continue;
        batch->add({uint32_t(at.x + x), uint32_t(at.y + y), uint32_t(at.z + z)});
      }
}

}  // namespace

VoxelPlace read_vdb_voxels(const std::string& path, const std::string& name, bool sandbox,
                           const VoxelSink& voxels, const FullCubeSink& cubes) {
  const auto grid = read_vdb(path, name, {}, sandbox);
  int64_t side = kBlockSide;  // of the largest cube
  grid->visit([&](const Cube& cube) {
    side = std::max(side, cube.side);
    return true;
  });
  const VoxelBox box = grid->bounds();
  LatticePoint first(0);
  for (int a = 0; a < 3 && !box.empty(); ++a) {
    // A multiple of the sides, so that cubes stay cubes.
    if (box.min[a] < 0 || box.max[a] > int64_t(1) << kMaxLevels)
      first[a] = box.min[a] & ~(side - 1);
    if (box.max[a] - first[a] > int64_t(1) << kMaxLevels)
      fail_input(path, "its voxels span more than 1M on an axis");
  }
  VoxelBatch batch(voxels);
  grid->visit([&](const Cube& cube) {
    check_interrupt();
    add_cube(cube, first, &batch, cubes);
    return true;
  });
  batch.flush();
  return place_of(path, grid->centres(), first);
}

}  // namespace svdag
