// A `.svdag` file as a graph, at its own resolution or at that of a coarser level.
#pragma once

#include "io/dag/dag_file.h"
#include "io/dag/dag_level.h"
#include "io/dag/node_graph.h"

namespace svdag {

class DagGraph final : public NodeGraph {
 public:
  // `levels`: 3 .. L; L for the file's own resolution. `file` must outlive this.
  DagGraph(const DagFile& file, int levels) : view_(file.view()), grid_(file.grid()) {
    if (levels < grid_.levels) grid_ = level_grid(grid_, levels);
    const LayerTable& table = file.layers();
    if (table.has_union) roots_.push_back(view_.empty() ? kNoChild : 0);
    for (const Layer& one : table.layers) roots_.push_back(file.root_node(one.root));
  }

  Grid grid() const override { return grid_; }
  // Of the union, if the file has it, and of each layer of the table.
  std::vector<uint32_t> roots() const override { return roots_; }
  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    std::array<uint32_t, 8> children;
    for (unsigned c = 0; c < 8; ++c) children[c] = dag_child(view_, uint32_t(level), id, c);
    return children;
  }
  Brick brick(uint32_t id) override { return dag_brick_at(view_, uint32_t(grid_.levels - 2), id); }

 private:
  const DagView& view_;
  Grid grid_;
  std::vector<uint32_t> roots_;
};

}  // namespace svdag
