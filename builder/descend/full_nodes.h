// The nodes of cubes whose voxels are all set, or all that are in the selection: one per level, and
// per way in which the selection cuts a cube, however many such cubes a solid has.
#pragma once

#include <array>
#include <vector>

#include "builder/octree/octree_cube.h"
#include "builder/reduce/node_table.h"

namespace svdag {

class FullNodes {
 public:
  explicit FullNodes(NodeTable* table) : table_(table), nodes_(size_t(table->levels())) {}

  // The root of a full cube of `level`.
  uint32_t root(int level) {
    uint32_t& node = nodes_[size_t(level)][0];
    if (node == 0) {
      NodeKey key;
      if (level < table_->brick_level()) key.fill(root(level + 1));
      node = level == table_->brick_level() ? table_->add_brick(~Brick(0))
                                            : table_->add_node(level, key);
    }
    return node;
  }
  SubDag sub_dag(int level) { return {root(level), uint64_t(1) << 3 * (table_->levels() - level)}; }

  // A slot for the root of a full cube of which `selection` cuts a part off; 0: not computed yet.
  // Cubes of a level that the selection's planes cut in the same directions hold the same voxels,
  // as each plane cuts them at the same place.
  uint32_t* cut(const Cube& cube, const VoxelBox& selection) {
    const VoxelBox voxels = cube.voxels(table_->levels());
    size_t planes = 0;
    for (int a = 0; a < 3; ++a) {
      planes =
          4 * planes + 2 * (voxels.min[a] < selection.min[a]) + (voxels.max[a] > selection.max[a]);
    }
    return &nodes_[size_t(cube.level)][planes];
  }

  // Replaces pending handles; must be called after each flush of the table.
  void settle() {
    for (size_t level = 0; level + 1 < nodes_.size(); ++level) {
      for (uint32_t& node : nodes_[level]) node = table_->settled(int(level), node);
    }
  }
  // Must be called when the table is emptied.
  void drop() {
    for (auto& nodes : nodes_) nodes.fill(0);
  }

 private:
  NodeTable* table_;
  std::vector<std::array<uint32_t, 64>> nodes_;  // [level][planes that cut the cube]
};

}  // namespace svdag
