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
  }

  Grid grid() const override { return grid_; }
  std::array<uint32_t, 8> children(int level, uint32_t id) override {
    std::array<uint32_t, 8> children;
    for (unsigned c = 0; c < 8; ++c)
      children[c] = view_.empty() ? kNoChild : dag_child(view_, uint32_t(level), id, c);
    return children;
  }
  Brick brick(uint32_t id) override {
    return view_.empty() ? 0 : dag_brick_at(view_, uint32_t(grid_.levels - 2), id);
  }

 private:
  const DagView& view_;
  Grid grid_;
};

}  // namespace svdag
