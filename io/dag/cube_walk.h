// The voxels of a box of one level of a DAG, as blocks and larger full cubes.
//
// Depth first, in Morton order; neither empty space nor the inside of a full cube is visited. Time
// is proportional to the blocks that are emitted, not to the volume.
//
// Notation: K = the level whose nodes are the voxels, b = K - 3 the level whose nodes are the
// blocks. Whether a node is full, and how many voxels it holds, is found once per DAG node and
// remembered.
#pragma once

#include <unordered_map>
#include <vector>

#include "io/dag/dag_view.h"
#include "io/dag/voxel_cube.h"

namespace svdag {

// How many blocks of 8^3, and cubes of 128^3 and 4096^3, hold something.
struct CubeCounts {
  uint64_t blocks = 0, middle = 0, large = 0;
};

class CubeWalk {
 public:
  // Of the voxels of level `levels`, 3 .. L. `dag` must outlive this.
  CubeWalk(const DagView& dag, uint32_t levels);

  // Passes the set voxels of `box` to the sink until it returns false; returns false then.
  bool visit(const VoxelBox& box, const VoxelCubeSink& sink);
  // What visit() would touch, inside full cubes too; stops counting beyond `most` blocks.
  CubeCounts count_cubes(const VoxelBox& box, uint64_t most);
  // The number of voxels set in `box`.
  uint64_t count_voxels(const VoxelBox& box);
  // The memory that count_voxels(box) takes at once, in bytes; what it remembers is not in it.
  uint64_t bytes_to_count(const VoxelBox& box) const;
  // The voxels origin .. origin + 7; the origin is anywhere, also outside the grid.
  Block block(const LatticePoint& origin) const;

 private:
  struct At {
    uint32_t level, node;
    LatticePoint origin;
  };

  int64_t side(uint32_t level) const { return int64_t(1) << (levels_ - level); }
  bool is_all(const VoxelBox& box) const;
  At child(const At& at, unsigned c) const;
  Brick brick(const LatticePoint& at) const;
  bool full(uint32_t level, uint32_t node);
  uint64_t voxels_below(uint32_t level, uint32_t node);
  bool visit(const At& at, const VoxelBox& box, const VoxelCubeSink& sink);
  void count(const At& at, const VoxelBox& box, uint64_t most, CubeCounts* counts) const;
  uint64_t count_voxels(const At& at, const VoxelBox& box);

  DagView dag_;
  uint32_t levels_;
  std::vector<std::unordered_map<uint32_t, bool>> full_;        // [level], of nodes with 8 children
  std::vector<std::unordered_map<uint32_t, uint64_t>> voxels_;  // [level]
};

}  // namespace svdag
