// Set voxels of another program, one by one or as cubes.
//
// A file that lists voxels (npz, binvox, vox) hands them to a sink in batches, in its own order,
// repetitions included; their placement is known at the end. A sparse volume (vdb) has
// cubes besides that are set as a whole.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "io/grid.h"

namespace svdag {

using Voxel = std::array<uint32_t, 3>;  // x, y, z, below 2^20 each
using VoxelSink = std::function<void(std::span<const Voxel>)>;

// A cube of voxels that are all set; its origin is a multiple of its side.
struct FullCube {
  Voxel origin;
  int log2_side;  // 3 .. 20
};
using FullCubeSink = std::function<void(const FullCube&)>;

// Where voxel (0, 0, 0) has its corner, how large a voxel is, and how many there are per axis. What
// a file does not say is 0, 1 and 0.
struct GridPlacement {
  Point corner{0};
  double voxel_size = 1;
  uint64_t resolution = 0;  // at least; 0: as many as the voxels need
};

// Collects voxels into batches.
class VoxelBatch {
 public:
  explicit VoxelBatch(const VoxelSink& sink) : sink_(sink) {}
  void add(const Voxel& voxel) {
    if (voxels_.size() == kBatch) flush();
    voxels_.push_back(voxel);
  }
  void flush() {
    if (!voxels_.empty()) sink_(voxels_);
    voxels_.clear();
  }

 private:
  static constexpr size_t kBatch = size_t(1) << 14;

  const VoxelSink& sink_;
  std::vector<Voxel> voxels_;
};

}  // namespace svdag
