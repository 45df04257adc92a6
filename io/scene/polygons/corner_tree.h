// Corners of a polygon indexed by position: finds those in a region without testing all.
//
// A k-d tree (Bentley 1975) over fixed points that are removed one by one. Each node stores the
// box of its points and the number of those that remain.
// Rejected: a uniform grid, where one cell may hold nearly all corners of an outline that has
// a fine part and a distant corner: every search there would be linear.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <numeric>
#include <span>
#include <vector>

namespace svdag {

struct FlatBox {
  glm::dvec2 min, max;
};

class CornerTree {
 public:
  static constexpr uint32_t kNone = UINT32_MAX;
  // Max bytes per corner: its indices, and its share of the nodes.
  static constexpr size_t kBytesPerCorner = 2 * sizeof(uint32_t) + 8;

  // Points 0 ... n-1.
  void build(std::span<const glm::dvec2> points);
  void remove(uint32_t corner);
  // The box of all points, including removed ones.
  const FlatBox& box() const { return nodes_[0].box; }

  // A remaining corner for which is(corner) is true, or kNone. Skips nodes for which may_hold(box)
  // is false.
  template <class MayHold, class Is>
  uint32_t find(const MayHold& may_hold, const Is& is) const;

 private:
  static constexpr uint32_t kLeaf = 16;  // max corners of a leaf

  struct Node {
    FlatBox box;
    uint32_t left = 0;  // corners that were not removed
  };
  // Children of node k: 2k + 1 with the first half of its corners, 2k + 2 with the others.
  struct Range {
    uint32_t node, begin, end;  // into order_

    bool is_leaf() const { return end - begin <= kLeaf; }
    uint32_t middle() const { return begin + (end - begin) / 2; }
    Range low() const { return {2 * node + 1, begin, middle()}; }
    Range high() const { return {2 * node + 2, middle(), end}; }
  };

  Range root() const { return {0, 0, uint32_t(order_.size())}; }
  void build(std::span<const glm::dvec2> points, const Range& range);

  std::vector<Node> nodes_;
  std::vector<uint32_t> order_;  // corners of a leaf are consecutive, remaining ones first
  std::vector<uint32_t> place_;  // [corner]: its index in order_
};

template <class MayHold, class Is>
uint32_t CornerTree::find(const MayHold& may_hold, const Is& is) const {
  std::array<Range, 64> stack;  // at most one pending in each level
  size_t waiting = 0;
  stack[waiting++] = root();
  while (waiting > 0) {
    const Range range = stack[--waiting];
    const Node& node = nodes_[range.node];
    if (node.left == 0 || !may_hold(node.box)) continue;
    if (!range.is_leaf()) {
      stack[waiting++] = range.high();
      stack[waiting++] = range.low();
      continue;
    }
    for (uint32_t i = range.begin; i < range.begin + node.left; ++i) {
      if (is(order_[i])) return order_[i];
    }
  }
  return kNone;
}

}  // namespace svdag
