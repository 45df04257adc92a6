// The voxels of an OpenVDB grid (mask, or bool) as a list.
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
  // Reads the grid. One that spans more than 1M voxels on an axis, and transforms that turn, or
  // that are not the same on all axes, are an Error (kBadInput).
  VdbVoxels(const std::string& path, const std::string& grid, bool sandbox);

  // A full tile stands for up to 2^36 voxels, so this may be far beyond what the file's size tells.
  uint64_t count() const { return count_; }
  // Hands on every voxel once.
  VoxelPlace read(const VoxelSink& sink) const;

 private:
  std::unique_ptr<VdbGrid> grid_;
  LatticePoint first_{0};  // becomes voxel (0, 0, 0)
  VoxelPlace place_;
  uint64_t count_ = 0;
};

}  // namespace svdag
