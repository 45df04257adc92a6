// A VDB grid that is a set of voxels and some tiles, without OpenVDB.
#pragma once

#include <map>

#include "io/formats/vdb.h"
#include "tests/voxel_sets.h"

namespace svdag {

class FakeVdb final : public VdbGrid {
 public:
  FakeVdb(const IndexToWorld& centres, const VoxelSet& voxels, std::vector<VoxelCube> tiles = {})
      : centres_(centres), cubes_(std::move(tiles)), all_(voxels) {
    for (const VoxelCube& tile : cubes_) add_cube(&all_, tile);
    std::map<std::array<int64_t, 3>, Block> leaves;
    for (const auto& [x, y, z] : voxels)
      leaves[{x & ~7, y & ~7, z & ~7}].set(unsigned(x & 7), unsigned(y & 7), unsigned(z & 7));
    for (const auto& [at, block] : leaves) cubes_.push_back({{at[0], at[1], at[2]}, 8, block});
  }

  std::string name() const override { return "fake"; }
  std::string type() const override { return "mask"; }
  const IndexToWorld& centres() const override { return centres_; }
  VoxelBox bounds() const override {
    VoxelBox box;
    for (size_t i = 0; i < cubes_.size(); ++i)
      for (int a = 0; a < 3; ++a) {
        const VoxelBox part = cubes_[i].box();
        box.min[a] = i == 0 ? part.min[a] : std::min(box.min[a], part.min[a]);
        box.max[a] = i == 0 ? part.max[a] : std::max(box.max[a], part.max[a]);
      }
    return box;
  }
  bool visit(const VoxelCubeSink& sink) const override {
    for (const VoxelCube& cube : cubes_)
      if (!sink(cube)) return false;
    return true;
  }
  bool get(const LatticePoint& v) const override { return all_.count({v.x, v.y, v.z}) != 0; }
  const VoxelSet& voxels() const { return all_; }

 private:
  IndexToWorld centres_;
  std::vector<VoxelCube> cubes_;
  VoxelSet all_;
};

// The centres of `grid` in an index space of other axes: their a runs along ours axis[a], backwards
// where sign[a] < 0, and their voxel 0 is our voxel `zero`.
inline IndexToWorld turned_centres(const Grid& grid, const std::array<int, 3>& axis,
                                   const std::array<int, 3>& sign, const LatticePoint& zero) {
  const IndexToWorld ours = voxel_centres(grid);
  IndexToWorld theirs;
  theirs.origin = ours(Point(zero));
  for (size_t a = 0; a < 3; ++a) theirs.axes[a] = double(sign[a]) * ours.axes[size_t(axis[a])];
  return theirs;
}

}  // namespace svdag
