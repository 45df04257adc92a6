// What of an OpenVDB grid is set, as voxels and as cubes.
#pragma once

#include <memory>
#include <string>

#include "io/formats/vdb.h"
#include "io/voxel_source.h"

namespace svdag {

// Voxel numbers are those of the grid's index space; if some are below 0, or all beyond 1M, the set
// is moved to begin near 0.
class VdbVoxels {
 public:
  // A grid that spans more than 1M voxels on an axis, and transforms that turn, or that are not the
  // same on all axes, are an Error (kBadInput) that names `path`.
  VdbVoxels(std::unique_ptr<VdbGrid> grid, const std::string& path);

  // Number of voxels that are passed one by one.
  uint64_t count() const { return count_; }
  // Passes every voxel once, those of tiles and full leaves as cubes.
  GridPlacement read(const VoxelSink& voxels, const FullCubeSink& cubes) const;

 private:
  std::unique_ptr<VdbGrid> grid_;
  LatticePoint first_{0};  // becomes voxel (0, 0, 0)
  GridPlacement place_;
  uint64_t count_ = 0;
};

}  // namespace svdag
