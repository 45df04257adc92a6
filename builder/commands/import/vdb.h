// The set voxels of an OpenVDB grid as a source of an import: single voxels and full cubes.
#pragma once

#include <memory>
#include <string>

#include "io/formats/vdb.h"
#include "io/voxel_source.h"

namespace svdag {

// Voxel coordinates are those of the grid's index space. On an axis where one is outside
// 0 .. 1M - 1, all are shifted to begin near 0.
class VdbVoxels {
 public:
  // Error (kBadInput), naming `path`, if the voxels span more than 1M on an axis or the transform
  // rotates, mirrors or stretches.
  VdbVoxels(std::unique_ptr<VdbGrid> grid, const std::string& path);

  // Number of voxels that read() passes one by one.
  uint64_t count() const { return count_; }
  // Passes every voxel once; tiles and full leaves are passed as cubes.
  GridPlacement read(const VoxelSink& voxels, const FullCubeSink& cubes) const;

 private:
  std::unique_ptr<VdbGrid> grid_;
  LatticePoint first_{0};  // index-space voxel that becomes (0, 0, 0)
  GridPlacement place_;
  uint64_t count_ = 0;
};

}  // namespace svdag
