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

  // Of the sets; roots and voxels are not set. One chosen layer is a set without layers. Several
  // have no union: UnitedGraph makes it.
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

}  // namespace svdag
