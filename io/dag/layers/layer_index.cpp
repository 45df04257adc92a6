#include "io/dag/layers/layer_index.h"

#include <algorithm>
#include <optional>

namespace svdag {
namespace {

constexpr uint32_t kLevel = 5;                   // 32,768 cubes
constexpr size_t kMaxEntries = size_t(1) << 22;  // else a coarser level, down to 1

struct Found {
  uint32_t cube;
  LayerIndexView::Entry entry;
};

// The nodes of the next level, ascending by layer as `found`; nothing if they are too many.
std::optional<std::vector<Found>> children_of(const DagView& dag, uint32_t level,
                                              std::span<const Found> found) {
  std::vector<Found> children;
  for (const Found& parent : found) {
    dag_for_children(dag, level, parent.entry.node, [&](unsigned c, uint32_t child) {
      children.push_back({parent.cube << 3 | c, {parent.entry.layer, child}});
    });
    if (children.size() > kMaxEntries) return std::nullopt;
  }
  return children;
}

}  // namespace

LayerIndex::LayerIndex(uint32_t levels, size_t layers,
                       const std::function<DagView(size_t)>& view_of)
    : level_(1) {
  std::vector<Found> found;
  for (uint32_t layer = 0; layer < layers; ++layer) {
    const DagView dag = view_of(layer);
    if (dag.empty()) continue;
    dag_for_children(dag, 0, 0, [&](unsigned c, uint32_t child) {
      found.push_back({c, {layer, child}});
    });
  }
  for (; !found.empty() && level_ < std::min(kLevel, levels - 2); ++level_) {
    auto children = children_of(view_of(0), level_, found);  // below level 0, views are the same
    if (!children) break;
    found = std::move(*children);
  }
  begin_.assign((size_t(1) << 3 * level_) + 1, 0);
  for (const Found& f : found) ++begin_[f.cube + 1];
  for (size_t cube = 1; cube < begin_.size(); ++cube) begin_[cube] += begin_[cube - 1];
  entries_.resize(found.size());
  std::vector<uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const Found& f : found) entries_[next[f.cube]++] = f.entry;
}

}  // namespace svdag
