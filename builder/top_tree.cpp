#include "builder/top_tree.h"

#include <algorithm>

#include "builder/merge.h"

namespace svdag {

std::vector<NodeKey> TopTree::sorted_nodes() {
  // Siblings are consecutive in Morton order: one pass makes the parents.
  std::vector<Place> parents;
  std::vector<NodeKey> keys;
  for (const Place& place : places_) {
    if (parents.empty() || parents.back().morton != place.morton >> 3) {
      parents.push_back({place.morton >> 3, uint32_t(keys.size())});
      keys.push_back({});
    }
    keys.back()[place.morton & 7] = 1 + place.index;
  }
  nodes_ = keys;
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (Place& parent : parents) {
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), keys[parent.index]);
    parent.index = uint32_t(at - nodes_.begin());
  }
  places_ = std::move(parents);
  return nodes_;
}

void TopTree::resolve(int level, const std::vector<HugeVector<uint32_t>>& run_maps,
                      const HugeVector<uint32_t>& top_map) {
  for (Place& place : places_) place.index = top_map[place.index];
  for (const CellRoot& root : roots_) {
    if (root.cell.level == level)
      places_.push_back({morton(root.cell.coordinate), run_maps[root.run][root.rank]});
  }
  std::sort(places_.begin(), places_.end(),
            [](const Place& a, const Place& b) { return a.morton < b.morton; });
}

}  // namespace svdag
