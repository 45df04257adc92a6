#include "io/scene/polygons/corner_tree.h"

#include <bit>
#include <glm/common.hpp>

namespace svdag {

void CornerTree::build(std::span<const glm::dvec2> points) {
  const uint32_t n = uint32_t(points.size());
  order_.resize(n);
  std::iota(order_.begin(), order_.end(), 0U);
  place_.resize(n);
  // `nodes` of a level: its ranges hold at most kLeaf corners.
  const uint32_t leaves = std::bit_ceil((n + kLeaf - 1) / kLeaf);
  nodes_.assign(size_t(2) * leaves - 1, Node());
  build(points, root());
}

void CornerTree::build(std::span<const glm::dvec2> points, const Range& range) {
  Node& node = nodes_[range.node];
  node.left = range.end - range.begin;
  FlatBox& box = node.box;
  box = {points[order_[range.begin]], points[order_[range.begin]]};
  for (uint32_t i = range.begin; i < range.end; ++i) {
    box.min = glm::min(box.min, points[order_[i]]);
    box.max = glm::max(box.max, points[order_[i]]);
  }
  if (range.is_leaf()) {
    for (uint32_t i = range.begin; i < range.end; ++i) place_[order_[i]] = i;
    return;
  }
  const int axis = box.max.x - box.min.x > box.max.y - box.min.y ? 0 : 1;
  std::nth_element(order_.begin() + range.begin, order_.begin() + range.middle(),
                   order_.begin() + range.end,
                   [&](uint32_t a, uint32_t b) { return points[a][axis] < points[b][axis]; });
  build(points, range.low());
  build(points, range.high());
}

void CornerTree::remove(uint32_t corner) {
  const uint32_t place = place_[corner];
  Range range = root();
  for (; !range.is_leaf(); range = place < range.middle() ? range.low() : range.high())
    --nodes_[range.node].left;
  const uint32_t last = range.begin + --nodes_[range.node].left;
  std::swap(order_[place], order_[last]);
  place_[order_[place]] = place;
  place_[corner] = last;
}

}  // namespace svdag
