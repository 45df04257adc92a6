// Sets of voxels of a `.svdag` file as a graph, at the resolution of the file or of a coarser
// level.
#pragma once

#include <string>
#include <vector>

#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "io/dag/graph/node_graph.h"

namespace svdag {

class DagGraph final : public NodeGraph {
 public:
  // `levels`: 3 .. L; L for the file's own resolution. `chosen`: the only layers; empty: all, and
  // the union. `file` must outlive this. Error (kUsage) if a layer is not in the file.
  DagGraph(const DagFile& file, int levels, const std::vector<std::string>& chosen = {});
  // Only the set that view() shows, as a graph without layers.
  static DagGraph of_view(const DagFile& file, int levels);

  // Of the sets; roots and voxels are not set. Chosen layers have no union: UnitedGraph makes it.
  const LayerTable& layers() const { return layers_; }

  Grid grid() const override { return grid_; }
  // Of the union, if layers() has it, and of each layer.
  std::vector<uint32_t> roots() const override { return roots_; }
  GraphFacts facts() const override;
  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    std::array<uint32_t, 8> children;
    children.fill(kNoChild);
    dag_for_children(view_, uint32_t(level), id,
                     [&](unsigned c, uint32_t child) { children[c] = child; });
    return children;
  }
  Brick brick(uint32_t id) override { return dag_brick_at(view_, uint32_t(grid_.levels - 2), id); }

 private:
  struct Nothing {};
  DagGraph(const DagFile& file, int levels, Nothing);
  void add(uint32_t root, uint64_t voxels);

  const DagFile& file_;
  const DagView& view_;
  Grid grid_;
  LayerTable layers_;
  std::vector<uint32_t> roots_;
  std::vector<uint64_t> voxels_;  // [root], at the file's resolution
  bool is_whole_ = false;         // all sets of the file
};

// A box of set voxels as a graph.
//
// The id of a node says what the box cuts off its cube, two bits an axis: the cube's lower side is
// outside, its upper side is outside. On an axis the box then begins (ends) in the cube, at the one
// position that the level has for it; so a level has at most 64 nodes, and none needs storage.
class BoxGraph final : public NodeGraph {
 public:
  // `box`: not empty, in the grid.
  BoxGraph(const Grid& grid, const VoxelBox& box) : grid_(grid), box_(box) {}

  Grid grid() const override { return grid_; }
  std::vector<uint32_t> roots() const override {
    uint32_t id = 0;
    for (int a = 0; a < 3; ++a) id |= cut(a, box_.min[a] > 0, box_.max[a] < grid_.resolution());
    return {id};
  }
  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    std::array<uint32_t, 8> children;
    const int64_t half = grid_.resolution() >> (level + 1);
    for (unsigned c = 0; c < 8; ++c) children[c] = child(id, c, half);
    return children;
  }
  Brick brick(uint32_t id) override {
    Brick brick = 0;
    for (unsigned bit = 0; bit < 64; ++bit) {
      const auto [x, y, z] = brick_voxel(bit);
      const LatticePoint v(x, y, z);
      bool inside = true;
      for (int a = 0; a < 3; ++a)
        inside = inside && v[a] >= first(id, a, kBrickSide) && v[a] < end(id, a, kBrickSide);
      brick |= Brick(inside) << bit;
    }
    return brick;
  }

 private:
  static uint32_t cut(int axis, bool below, bool above) {
    return (uint32_t(below) | uint32_t(above) << 1) << 2 * axis;
  }
  // The box in a cube of this side on an axis, relative to the cube.
  int64_t first(uint32_t id, int axis, int64_t side) const {
    return id >> 2 * axis & 1 ? box_.min[axis] & (side - 1) : 0;
  }
  int64_t end(uint32_t id, int axis, int64_t side) const {
    return id >> 2 * axis & 2 ? ((box_.max[axis] - 1) & (side - 1)) + 1 : side;
  }
  uint32_t child(uint32_t id, unsigned c, int64_t half) const {
    uint32_t result = 0;
    for (int a = 0; a < 3; ++a) {
      const int64_t begin = (c >> (2 - a) & 1) * half;
      const int64_t low = first(id, a, 2 * half) - begin, high = end(id, a, 2 * half) - begin;
      if (low >= half || high <= 0) return kNoChild;
      result |= cut(a, low > 0, high < half);
    }
    return result;
  }

  Grid grid_;
  VoxelBox box_;
};

}  // namespace svdag
