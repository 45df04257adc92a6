#include "io/dag/layers/layer_stats.h"

#include <algorithm>

#include "io/dag/write/node_starts.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

class Walk {
 public:
  Walk(const DagFile& file, const WorkRoom& room) : dag_(file.view()) {
    for (uint32_t level = 1; level <= dag_.brick_level(); ++level) {
      const bool by_words = level < dag_.brick_level() && dag_.layout == Layout::kPlain;
      starts_.emplace_back(room.budget, "numbers of nodes");
      if (by_words) starts_.back() = node_starts(dag_, level, room.budget);
      const uint64_t nodes = file.header().sections[level].nodes;
      last_.emplace_back(nodes, room);
      owner_.emplace_back(nodes, room);
    }
  }

  // Walks what the root of `view` reaches; returns the number of nodes. `tag`: of this walk, not 0.
  uint64_t run(const DagView& view, uint32_t tag) {
    check_interrupt();
    tag_ = tag;
    nodes_ = 0;
    if (view.empty()) return 0;
    ++nodes_;
    dag_for_children(view, 0, 0, [&](unsigned, uint32_t child) { visit(1, child); });
    return nodes_;
  }
  // [tag]: number of nodes, except roots, that only this walk reached.
  std::vector<uint64_t> own(uint32_t tags) const {
    std::vector<uint64_t> own(tags + 1);
    for (const WorkArray<uint32_t>& owners : owner_) {
      for (const uint32_t tag : owners.elements()) {
        if (tag != kMany && tag != 0) ++own[tag];
      }
    }
    return own;
  }

 private:
  static constexpr uint32_t kMany = UINT32_MAX;

  void visit(uint32_t level, uint32_t index) {
    const RankBitmap& starts = starts_[level - 1];
    const bool by_words = level < dag_.brick_level() && dag_.layout == Layout::kPlain;
    const uint32_t number = by_words ? starts.rank(index) : index;
    uint32_t& last = last_[level - 1][number];
    if (last == tag_) return;
    last = tag_;
    ++nodes_;
    uint32_t& owner = owner_[level - 1][number];
    owner = owner == 0 ? tag_ : kMany;
    if (level < dag_.brick_level())
      dag_for_children(dag_, level, index,
                       [&](unsigned, uint32_t child) { visit(level + 1, child); });
  }

  const DagView& dag_;
  // [level - 1]
  std::vector<RankBitmap> starts_;
  std::vector<WorkArray<uint32_t>> last_,
      owner_;  // [number]: tag of the last walk, of the only one
  uint32_t tag_ = 0;
  uint64_t nodes_ = 0;
};

}  // namespace

std::vector<LayerStats> layer_stats(const DagFile& file, const WorkRoom& room) {
  const std::vector<Layer>& layers = file.layers().layers;
  // A walk per root: number 0 is the union, if there is one.
  const uint64_t roots = file.header().sections[0].nodes;
  std::vector<uint32_t> users(roots);
  if (file.layers().has_union && roots > 0) ++users[0];
  for (const Layer& layer : layers) {
    if (layer.root != kNoRoot) ++users[layer.root];
  }
  Walk walk(file, room);
  std::vector<uint64_t> nodes(roots);
  if (file.layers().has_union && roots > 0) nodes[0] = walk.run(file.view(), 1);
  for (size_t i = 0; i < layers.size(); ++i) {
    const uint32_t root = layers[i].root;
    if (root != kNoRoot && nodes[root] == 0) nodes[root] = walk.run(file.view_of(i), root + 1);
  }
  const std::vector<uint64_t> own = walk.own(uint32_t(roots));
  std::vector<LayerStats> stats(layers.size());
  for (size_t i = 0; i < layers.size(); ++i) {
    const uint32_t root = layers[i].root;
    if (root == kNoRoot) continue;
    stats[i].nodes = nodes[root];
    if (users[root] == 1) stats[i].own = own[root + 1] + 1;  // with the root
  }
  return stats;
}

}  // namespace svdag
