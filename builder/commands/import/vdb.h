// The set voxels of an OpenVDB grid as a source of an import: single voxels and full cubes.
#pragma once

#include <memory>
#include <string>

#include "io/formats/vdb.h"
#include "io/voxel_source.h"

namespace svdag {

// Voxel coordinates are those of the grid's index space; if one is outside 0 .. 1M - 1, the set is
// moved to begin near 0 on that axis.
class VdbVoxels {
 public:
  // A grid of more than 1M voxels on an axis, and a transform that rotates, mirrors or stretches,
  // are an Error (kBadInput) that names `path`.
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
