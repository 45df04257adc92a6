// The octree above the cells, built upwards level by level during the merge, up to the tops of the
// merged part (the root of the grid if the part is the whole grid); one octree for each layer and
// the union.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/octree/sub_dag_root.h"
#include "io/dag/write/node_key.h"

namespace svdag {

class TopTree {
 public:
  // The roots are in `part`, which must outlive the tree.
  // `with_union`: whether the roots that a layer shares with the union are roots of the union too.
  TopTree(std::vector<SubDagRoot> roots, const GridPart& part, bool with_union = true);

  // To be called after level `level` is merged, in this order: resolve_own() with the indices of
  // the nodes that sorted_nodes() returned; resolve_run() for each run with its map from rank to
  // index, or once per window of that map; end_level().
  template <class Map>
  void resolve_own(const Map& indices) {
    for (TopCube& cube : cubes_) cube.index = indices[cube.index];
  }
  template <class Map>
  void resolve_run(int level, uint32_t run, const Map& map) {
    for (auto [root, end] = roots_of(level, run); root != end; ++root)
      if (map.holds(root->rank))
        cubes_.push_back({root->sets.subject, root->morton, map[root->rank]});
  }
  void end_level(int level);

  // The parents of the cubes resolved last, as ascending, unique nodes.
  const std::vector<NodeKey>& sorted_nodes();

  // After end_level(0): the non-empty tops of the part; their `rank` is the global index.
  std::vector<SubDagRoot> take_tops() { return std::move(tops_); }

 private:
  struct TopCube {
    Subject subject;  // one set
    uint64_t morton;  // of the cube at the current level
    uint32_t index;   // global index once resolved; before that, index in nodes_
  };
  using Roots = std::vector<SubDagRoot>::const_iterator;

  std::pair<Roots, Roots> roots_of(int level, uint32_t run) const;

  std::vector<SubDagRoot> roots_;  // sorted by level and run
  const GridPart& part_;
  std::vector<SubDagRoot> tops_;
  std::vector<TopCube> cubes_;  // occupied cubes of the current level, by subject, ascending
  std::vector<NodeKey> nodes_;  // of the level being merged, ascending and unique
};

}  // namespace svdag
