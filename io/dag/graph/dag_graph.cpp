#include "io/dag/graph/dag_graph.h"

namespace svdag {

DagGraph::DagGraph(const DagFile& file, int levels, Nothing)
    : file_(file), view_(file.view()), grid_(file.grid()) {
  if (levels < grid_.levels) grid_ = level_grid(grid_, levels);
}

DagGraph::DagGraph(const DagFile& file, int levels, const std::vector<std::string>& chosen)
    : DagGraph(file, levels, Nothing()) {
  const LayerTable& table = file.layers();
  if (chosen.empty()) {
    is_whole_ = true;
    layers_ = table;
    if (table.has_union) add(view_.empty() ? kNoChild : 0, file.header().voxels);
    for (const Layer& layer : table.layers) add(file.root_node(layer.root), layer.voxels);
    return;
  }
  for (const size_t number : layers_named(table, chosen)) {
    const Layer& layer = table.layers[number];
    add(file.root_node(layer.root), layer.voxels);
    layers_.layers.push_back(layer);
  }
  layers_.kind = table.kind;
  layers_.has_union = false;
}

DagGraph DagGraph::of_view(const DagFile& file, int levels) {
  DagGraph graph(file, levels, Nothing());
  graph.add(graph.view_.empty() ? kNoChild : 0, file.header().voxels);
  return graph;
}

void DagGraph::add(uint32_t root, uint64_t voxels) {
  roots_.push_back(root);
  voxels_.push_back(voxels);
}

GraphFacts DagGraph::facts() const {
  GraphFacts facts;
  // The nodes of a coarser level are other ones: bricks that differ may become equal.
  if (grid_.levels < int(view_.levels)) return facts;
  facts.unique_end = kNoChild;
  facts.unique_ascend = view_.layout == Layout::kPlain;
  facts.path = file_.path();
  facts.voxels = voxels_;
  if (!is_whole_ || view_.layout == Layout::kPlain) return facts;
  facts.nodes.assign(view_.index_end, view_.index_end + view_.brick_level());
  facts.nodes.push_back(view_.brick_count);
  return facts;
}

}  // namespace svdag
