// A DAG against a VDB grid, voxel by voxel, without unpacking either.
//
// The VDB grid is walked leaf by leaf and tile by tile. A leaf is compared with the 8^3 voxels of
// the DAG at the same place, turned as the grids lie to each other. A tile is compared with the
// number of voxels that the DAG has there; only where it has some but not all, the tile is cut into
// the next smaller ones. What both have is then known, and with the DAG's own number of voxels so
// is what only the DAG has: its voxels are walked only if there is such a difference to show. That
// number is counted, node by node: a header may say anything. Time follows the leaves of the VDB
// grid, and the nodes of the DAG, not its voxels.
#pragma once

#include <vector>

#include "io/dag/cube_walk.h"
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
  // `window`, in voxels of the level, is compared alone, if given. All must outlive this.
  VdbComparer(const VdbGrid& theirs, CubeWalk* ours, const IndexMap& map, const VoxelBox* window);

  // Lists up to `show` voxels of each kind.
  VdbComparison compare(uint64_t show);
  // Puts the grids "missing" and "extra" into the writer, in the place and orientation of theirs.
  void write_difference(VdbWriter* writer);

 private:
  // Both take cubes of their index space.
  using Found = std::function<void(uint64_t both, const VoxelCube& missing)>;
  void split(const VoxelCube& cube, const Found& found);
  void compare_block(VoxelCube cube, const Found& found);
  Block ours(const LatticePoint& origin) const;
  // Passes our voxels that theirs lacks to the sink, until it returns false.
  void extras(const std::function<bool(const LatticePoint& ours)>& sink);
  // Of ours, where it is compared.
  VoxelBox window() const;

  const VdbGrid& theirs_;
  CubeWalk* ours_;
  IndexMap map_;
  const VoxelBox* window_;
  VoxelBox their_window_;
};

}  // namespace svdag
