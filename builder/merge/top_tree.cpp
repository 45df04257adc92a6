#include "builder/merge/top_tree.h"

#include <algorithm>
#include <utility>

#include "streaming/counts.h"

namespace svdag {
namespace {

std::pair<int32_t, uint32_t> level_and_run(const SubDagRoot& root) {
  return {root.level, root.run};
}

}  // namespace

TopTree::TopTree(std::vector<SubDagRoot> roots, const GridPart& part, bool with_union)
    : roots_(std::move(roots)), part_(part) {
  // From here on, a root is of one set.
  for (size_t i = 0, count = roots_.size(); i < count; ++i) {
    const SubDagSets sets = std::exchange(roots_[i].sets, SubDagSets::only(roots_[i].sets.subject));
    if (!is_layer(sets.subject) || !sets.in_union || !with_union) continue;
    roots_.push_back(roots_[i]);
    roots_.back().sets = {};
  }
  std::sort(roots_.begin(), roots_.end(), [](const SubDagRoot& a, const SubDagRoot& b) {
    return level_and_run(a) != level_and_run(b) ? level_and_run(a) < level_and_run(b)
                                                : a.morton < b.morton;
  });
}

std::pair<TopTree::Roots, TopTree::Roots> TopTree::roots_of(int level, uint32_t run) const {
  const auto before = [](const SubDagRoot& root, const std::pair<int32_t, uint32_t>& key) {
    return level_and_run(root) < key;
  };
  const auto begin = std::lower_bound(roots_.begin(), roots_.end(), std::pair(level, run), before);
  auto end = begin;
  while (end != roots_.end() && end->level == level && end->run == run) ++end;
  return {begin, end};
}

const std::vector<NodeKey>& TopTree::sorted_nodes() {
  // Siblings are consecutive in Morton order, so one pass builds the parents.
  std::vector<TopCube> parents;
  std::vector<NodeKey> keys;
  for (const TopCube& cube : cubes_) {
    if (parents.empty() || parents.back().subject != cube.subject ||
        parents.back().morton != cube.morton >> 3) {
      parents.push_back(
          {cube.subject, cube.morton >> 3, as_u32(keys.size(), "cubes above the cells")});
      keys.push_back({});
    }
    keys.back()[cube.morton & 7] = 1 + cube.index;
  }
  nodes_ = keys;
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (TopCube& parent : parents) {
    const auto at = std::lower_bound(nodes_.begin(), nodes_.end(), keys[parent.index]);
    parent.index = uint32_t(at - nodes_.begin());
  }
  cubes_ = std::move(parents);
  return nodes_;
}

void TopTree::end_level(int level) {
  std::sort(cubes_.begin(), cubes_.end(), [](const TopCube& a, const TopCube& b) {
    return std::pair(a.subject, a.morton) < std::pair(b.subject, b.morton);
  });
  std::erase_if(cubes_, [&](const TopCube& cube) {
    const bool top = part_.is_top(level, cube.morton);
    if (top) tops_.push_back({cube.morton, level, 0, cube.index, SubDagSets::only(cube.subject)});
    return top;
  });
}

}  // namespace svdag
