// The nodes of cubes whose voxels are all set, or all that are in the grid's selection: one per
// level, and per way in which the selection cuts a cube, however many such cubes a solid has.
#pragma once

#include <array>
#include <vector>

#include "builder/octree/octree_cube.h"
#include "builder/reduce/node_table.h"

namespace svdag {

// The voxels of `brick`, a cube of brick level, that are in `selection`.
inline Brick selected_voxels(const Cube& brick, const VoxelBox& selection) {
  const LatticePoint corner = brick.coordinate * int64_t(kBrickSide);
  Brick voxels = 0;
  for (unsigned bit = 0; bit < 64; ++bit) {
    const auto [x, y, z] = brick_voxel(bit);
    const LatticePoint at = corner + LatticePoint(x, y, z);
    if (selection.holds({at, at + int64_t(1)})) voxels |= Brick(1) << bit;
  }
  return voxels;
}

class FullNodes {
 public:
  FullNodes(const Grid& grid, NodeTable* table)
      : grid_(grid), table_(table), nodes_(size_t(table->levels())) {}

  // The sub-DAG of a full cube of `level` that is in the selection.
  SubDag sub_dag(int level) { return {root(level), uint64_t(1) << 3 * (table_->levels() - level)}; }
  // The selected part of a full cube.
  SubDag sub_dag(const Cube& cube) {
    const VoxelBox all = cube.voxels(table_->levels());
    if (!grid_.bounded || grid_.selection.holds(all)) return sub_dag(cube.level);
    if (!grid_.selection.meets(all)) return {};
    const LatticePoint side =
        glm::min(all.max, grid_.selection.max) - glm::max(all.min, grid_.selection.min);
    return {cut_root(cube, all), uint64_t(side.x) * uint64_t(side.y) * uint64_t(side.z)};
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

  // Cubes of a level that the planes of the selection cut in the same directions hold the same
  // voxels, since each plane cuts them at the same place.
  uint32_t cut_root(const Cube& cube, const VoxelBox& voxels) {
    size_t planes = 0;
    for (int a = 0; a < 3; ++a) {
      planes = 4 * planes + 2 * (voxels.min[a] < grid_.selection.min[a]) +
               (voxels.max[a] > grid_.selection.max[a]);
    }
    uint32_t& node = nodes_[size_t(cube.level)][planes];
    if (node == 0) {
      NodeKey key{};
      if (cube.level < table_->brick_level()) {
        for (unsigned c = 0; c < 8; ++c) key[c] = sub_dag(cube.child(c)).root;
      }
      node = cube.level == table_->brick_level()
                 ? table_->add_brick(selected_voxels(cube, grid_.selection))
                 : table_->add_node(cube.level, key);
    }
    return node;
  }

  Grid grid_;
  NodeTable* table_;
  std::vector<std::array<uint32_t, 64>> nodes_;  // [level][planes that cut the cube]
};

}  // namespace svdag
