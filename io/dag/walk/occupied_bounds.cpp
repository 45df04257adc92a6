#include "io/dag/walk/occupied_bounds.h"

#include <algorithm>
#include <unordered_map>
#include <vector>

namespace svdag {
namespace {

// The distance from one side of a node's cube to its first set voxel, in voxels, cached per node.
class SideDistance {
 public:
  // `axis`: 0 .. 2. `high`: distance from the upper side.
  SideDistance(const DagView& dag, int axis, bool high)
      : dag_(dag), bit_(4U >> axis), near_(high ? bit_ : 0), memo_(dag.brick_level()) {}

  uint32_t of(uint32_t node, uint32_t level) {
    if (level == dag_.brick_level()) return of_brick(dag_.bricks[node]);
    const auto [entry, is_new] = memo_[level].try_emplace(node, 0);
    if (!is_new) return entry->second;
    const uint32_t half = dag_.resolution() >> (level + 1);
    uint32_t distance = of_half(node, level, near_);
    if (distance == kNone) distance = half + of_half(node, level, near_ ^ bit_);
    return memo_[level][node] = distance;
  }

 private:
  static constexpr uint32_t kNone = UINT32_MAX;

  // The minimum over the children whose bit `bit_` equals `side`; kNone if there are none.
  uint32_t of_half(uint32_t node, uint32_t level, unsigned side) {
    uint32_t best = kNone;
    for (unsigned c = 0; c < 8 && best != 0; ++c) {
      if ((c & bit_) != side) continue;
      const uint32_t child = dag_child(dag_, level, node, c);
      if (child != kNoChild) best = std::min(best, of(child, level + 1));
    }
    return best;
  }

  uint32_t of_brick(uint64_t brick) const {
    uint32_t best = kNone;
    for (unsigned i = 0; i < 64; ++i) {
      if (!(brick >> i & 1)) continue;
      const uint32_t k = 2 * ((i >> 3 & bit_) != near_) + ((i & bit_) != near_);
      best = std::min(best, k);
    }
    return best;
  }

  const DagView& dag_;
  unsigned bit_, near_;
  std::vector<std::unordered_map<uint32_t, uint32_t>> memo_;  // [level]
};

}  // namespace

VoxelBox occupied_bounds(const DagView& dag) {
  VoxelBox box;
  if (dag.empty()) return box;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = SideDistance(dag, a, false).of(0, 0);
    box.max[a] = int64_t(dag.resolution()) - SideDistance(dag, a, true).of(0, 0);
  }
  return box;
}

Box world_box(const Grid& grid, const VoxelBox& voxels) {
  const Point corner = grid.corner();
  Box box;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = corner[a] + double(voxels.min[a]) * grid.voxel_size;
    box.max[a] = corner[a] + double(voxels.max[a]) * grid.voxel_size;
  }
  return box;
}

}  // namespace svdag
