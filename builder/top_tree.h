// The octree above the cells, built upwards while the merge goes from level to level.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "builder/run.h"

namespace svdag {

struct CellRoot;

class TopTree {
 public:
  explicit TopTree(std::span<const CellRoot> roots) : roots_(roots) {}

  // The parents of the cubes resolved last, as nodes, ascending without repeats.
  std::vector<NodeKey> sorted_nodes();
  // After level `level` was merged: `run_maps[r]` maps ranks of run r to global indices, `top_map`
  // the nodes returned by the last sorted_nodes().
  void resolve(int level, const std::vector<HugeVector<uint32_t>>& run_maps,
               const HugeVector<uint32_t>& top_map);

 private:
  struct Place {
    uint64_t morton;  // of the cube at the current level
    uint32_t index;   // resolved: global index; between the calls: position in nodes_
  };

  std::span<const CellRoot> roots_;
  std::vector<Place> places_;   // occupied cubes of the current level, ascending
  std::vector<NodeKey> nodes_;  // of the level being merged, ascending without repeats
};

}  // namespace svdag
