// Sinks for the set voxels of imported files, as lists of voxels or as full cubes.
//
// A reader of voxel lists (npz, binvox, vox) passes voxels to a sink in batches, in file order,
// with repetitions; their placement is known at the end. Sparse volumes (vdb) also contain full
// cubes. Voxels of layers have labels, the numbers of their layers.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "io/colour.h"
#include "io/grid.h"

namespace svdag {

using Voxel = std::array<uint32_t, 3>;  // x, y, z, below 2^20 each
// Takes voxels and, of a file with layers, a label of each, and of one with colours, a colour.
using VoxelSink =
    std::function<void(std::span<const Voxel>, std::span<const uint16_t>, std::span<const Colour>)>;

// A cube of voxels that are all set; its origin is a multiple of its side.
struct FullCube {
  Voxel origin;
  int log2_side;  // 3 .. 20
};
using FullCubeSink = std::function<void(const FullCube&)>;

// The world position of the corner of voxel (0, 0, 0), the voxel size, and the voxels per axis. The
// defaults apply to what a file does not specify. `grid`: the complete grid instead of these.
struct GridPlacement {
  Point corner{0};
  double voxel_size = 1;
  uint64_t resolution = 0;  // a minimum; 0: as many as the voxels need
  std::optional<Grid> grid = {};
};

// Collects voxels into batches.
class VoxelBatch {
 public:
  explicit VoxelBatch(const VoxelSink& sink) : sink_(sink) {}
  void add(const Voxel& voxel) {
    if (voxels_.size() == kBatch) flush();
    voxels_.push_back(voxel);
  }
  // Of the voxel that was added last. In a file with layers or colours every voxel has one.
  void add_label(uint16_t label) { labels_.push_back(label); }
  void add_colour(const Colour& colour) { colours_.push_back(colour); }
  void flush() {
    if (!voxels_.empty()) sink_(voxels_, labels_, colours_);
    voxels_.clear();
    labels_.clear();
    colours_.clear();
  }

 private:
  static constexpr size_t kBatch = size_t(1) << 14;

  const VoxelSink& sink_;
  std::vector<Voxel> voxels_;
  std::vector<uint16_t> labels_;
  std::vector<Colour> colours_;
};

}  // namespace svdag
