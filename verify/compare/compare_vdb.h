// Compares a DAG with a VDB grid, voxel by voxel, without unpacking either.
//
// The VDB grid is visited leaf by leaf and tile by tile. A leaf is compared with the 8^3 voxels of
// the DAG at the same position, with axes permuted as needed. A tile is compared with the number of
// voxels that the DAG has there; only if it has some but not all, the tile is divided into the next
// smaller ones. This gives the number of common voxels, and with the DAG's own number of voxels the
// number that only the DAG has: its voxels are visited only to list such differences. The DAG's
// number is counted node by node, because a header is not trusted. Time is proportional to the
// leaves of the VDB grid and the nodes of the DAG, not to its voxels.
#pragma once

#include <vector>

#include "io/dag/walk/cube_walk.h"
#include "io/formats/vdb.h"
#include "verify/compare/index_map.h"

namespace svdag {

struct VdbComparison {
  uint64_t both = 0;
  uint64_t missing = 0;                                  // set in the VDB grid, not in the file
  uint64_t extra = 0;                                    // set in the file, not in the VDB grid
  std::vector<LatticePoint> first_missing, first_extra;  // in voxels of the file's level

  bool same() const { return missing == 0 && extra == 0; }
};

class VdbComparer {
 public:
  // Compares only `window` (in voxels of the level), if given. All arguments must outlive this.
  VdbComparer(const VdbGrid& theirs, CubeWalk* ours, const IndexMap& map, const VoxelBox* window);

  // Lists up to `max_listed` voxels of each kind.
  VdbComparison compare(uint64_t max_listed);
  // Adds the grids "missing" and "extra" to the writer, with the transform of theirs.
  void write_difference(VdbWriter* writer);

 private:
  // split() and compare_block() take cubes of their index space.
  using Found = std::function<void(uint64_t both, const VoxelCube& missing)>;
  void split(const VoxelCube& cube, const Found& found);
  void compare_block(VoxelCube cube, const Found& found);
  Block our_block(const LatticePoint& origin) const;
  // Passes our voxels that theirs lacks to the sink until it returns false.
  void visit_extra(const std::function<bool(const LatticePoint& ours)>& sink);
  // The compared box, in our voxels.
  VoxelBox window() const;

  const VdbGrid& theirs_;
  CubeWalk* ours_;
  IndexMap map_;
  const VoxelBox* window_;
  VoxelBox their_window_;
};

}  // namespace svdag
