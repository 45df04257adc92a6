// Enumerates the voxels of a box of one level of a DAG, as blocks and larger full cubes.
//
// The walk is depth first, in Morton order, and skips empty space and the inside of full cubes. Its
// time is proportional to the number of emitted cubes, not to the volume. Whether a DAG node is
// full, and its number of voxels, is computed once per node and cached.
#pragma once

#include <unordered_map>
#include <vector>

#include "io/dag/dag_view.h"
#include "io/dag/walk/voxel_cube.h"

namespace svdag {

// The numbers of nonempty blocks of 8^3 (`blocks`) and cubes of 128^3 (`middle`) and 4096^3
// (`large`).
struct CubeCounts {
  uint64_t blocks = 0, middle = 0, large = 0;
};

class CubeWalk {
 public:
  // Walks the voxels of level `levels`, 3 .. L. The mapped data of `dag` must outlive this.
  CubeWalk(const DagView& dag, uint32_t levels);

  // Passes the set voxels of `box` to the sink. Returns false if the sink did, which ends the walk.
  bool visit(const VoxelBox& box, const VoxelCubeSink& sink);
  // Counts the blocks and cubes that `box` meets, full cubes divided into blocks; stops after
  // more than `max_blocks` blocks.
  CubeCounts count_cubes(const VoxelBox& box, uint64_t max_blocks);
  // The number of voxels set in `box`.
  uint64_t count_voxels(const VoxelBox& box);
  // The temporary memory of count_voxels(box), in bytes, without the cached counts.
  uint64_t counting_bytes(const VoxelBox& box) const;
  // Whether all voxels of a node are set. Below level 0, also of a layer of the same file.
  bool is_full(uint32_t level, uint32_t node);
  // The voxels origin .. origin + 7; the origin may be anywhere, also outside the grid.
  Block block(const LatticePoint& origin) const;

 private:
  struct WalkNode {
    uint32_t level, node;
    LatticePoint origin;
  };

  int64_t side(uint32_t level) const { return int64_t(1) << (levels_ - level); }
  bool covers_grid(const VoxelBox& box) const;
  WalkNode child(const WalkNode& at, unsigned c) const;
  Brick brick(const LatticePoint& at) const;
  uint64_t voxels_below(uint32_t level, uint32_t node);
  bool visit(const WalkNode& at, const VoxelBox& box, const VoxelCubeSink& sink);
  void count(const WalkNode& at, const VoxelBox& box, uint64_t max_blocks,
             CubeCounts* counts) const;
  uint64_t count_voxels(const WalkNode& at, const VoxelBox& box);

  DagView dag_;
  uint32_t levels_;
  std::vector<std::unordered_map<uint32_t, bool>> full_;        // [level], of nodes with 8 children
  std::vector<std::unordered_map<uint32_t, uint64_t>> voxels_;  // [level]
};

}  // namespace svdag
