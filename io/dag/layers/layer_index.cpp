#include "io/dag/layers/layer_index.h"

#include <algorithm>

#include "streaming/counts.h"

namespace svdag {
namespace {

constexpr uint32_t kLevel = 5;  // 32,768 cubes

struct Found {
  uint32_t cube;
  LayerIndexView::Entry entry;
};

// Appends the nodes of level `last` below `node`.
void collect(const DagView& dag, uint32_t level, uint32_t node, uint32_t last, uint32_t cube,
             uint32_t layer, std::vector<Found>* found) {
  if (level == last) return found->push_back({cube, {layer, node}});
  dag_for_children(dag, level, node, [&](unsigned c, uint32_t child) {
    collect(dag, level + 1, child, last, cube << 3 | c, layer, found);
  });
}

}  // namespace

LayerIndex::LayerIndex(uint32_t levels, size_t layers,
                       const std::function<DagView(size_t)>& view_of)
    : level_(std::min(kLevel, levels - 2)) {
  std::vector<Found> found;
  for (uint32_t layer = 0; layer < layers; ++layer) {
    const DagView dag = view_of(layer);
    if (!dag.empty()) collect(dag, 0, 0, level_, 0, layer, &found);
  }
  begin_.assign((size_t(1) << 3 * level_) + 1, 0);
  for (const Found& f : found) ++begin_[f.cube + 1];
  for (size_t cube = 1; cube < begin_.size(); ++cube) begin_[cube] += begin_[cube - 1];
  as_u32(found.size(), "layers of coarse cubes");
  entries_.resize(found.size());
  std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const Found& f : found) entries_[next[f.cube]++] = f.entry;
}

}  // namespace svdag
