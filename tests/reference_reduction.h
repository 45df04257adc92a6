// The plain way to a DAG, for comparison: all bricks of the SVO in a map, reduced level by level
// with ordered maps. Shares nothing with builder/ but the brick's bit order.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "io/dag/dag_view.h"

namespace svdag {

using Coordinate = std::array<uint32_t, 3>;
using BrickMap = std::map<Coordinate, uint64_t>;

// Unique nodes per level (0 .. L-2) of the SVO over `bricks`.
inline std::vector<uint64_t> reference_node_counts(const BrickMap& bricks, int levels) {
  std::vector<uint64_t> counts(size_t(levels) - 1);
  std::map<Coordinate, uint32_t> nodes;  // of one level, by place: 1 + class
  std::map<uint64_t, uint32_t> brick_classes;
  for (const auto& [place, brick] : bricks) {
    if (brick == 0) continue;
    nodes[place] = brick_classes.try_emplace(brick, brick_classes.size() + 1).first->second;
  }
  counts.back() = brick_classes.size();
  for (int level = levels - 3; level >= 0; --level) {
    std::map<Coordinate, std::array<uint32_t, 8>> parents;
    for (const auto& [p, node] : nodes) {
      const unsigned child = 4 * (p[0] & 1) + 2 * (p[1] & 1) + (p[2] & 1);
      parents[{p[0] / 2, p[1] / 2, p[2] / 2}][child] = node;
    }
    std::map<std::array<uint32_t, 8>, uint32_t> classes;
    nodes.clear();
    for (const auto& [place, children] : parents)
      nodes[place] = classes.try_emplace(children, classes.size() + 1).first->second;
    counts[size_t(level)] = classes.size();
  }
  return counts;
}

// All bricks that a file's DAG reaches.
inline void collect_bricks(const DagView& dag, uint32_t level, uint32_t node, Coordinate at,
                           BrickMap* out) {
  if (level == dag.brick_level()) {
    (*out)[at] = dag.bricks[node];
    return;
  }
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    if (child == kNoChild) continue;
    collect_bricks(dag, level + 1, child,
                   {2 * at[0] + (c >> 2 & 1), 2 * at[1] + (c >> 1 & 1), 2 * at[2] + (c & 1)}, out);
  }
}

inline BrickMap bricks_of(const DagView& dag) {
  BrickMap bricks;
  if (!dag.empty()) collect_bricks(dag, 0, 0, {0, 0, 0}, &bricks);
  return bricks;
}

}  // namespace svdag
