// From a cube and its triangles to the cube's sub-DAG: the octree descent.
//
// Invariant: the list of a cube holds every triangle that touches it (perhaps some that do not,
// never twice the same). Empty space is never visited: a child without triangles ends the descent.
// The result depends on the voxels alone, since only bricks decide and they decide exactly.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "builder/cell.h"
#include "builder/node_table.h"
#include "builder/kernels.h"
#include "io/grid.h"

namespace svdag {

// What the descent may use; the result is the same bits with any of it switched off.
struct DescentConfig {
  Rule rule = Rule::kConservative;
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;  // switch the edges of a triangle off where it covers a cube
};

// Divides `list`, the list of `cube`, among its children.
void divide_list(const EntryList& list, const Cube& cube, int levels, const DescentConfig& config,
                 std::array<EntryList, 8>* children);

class Descent {
 public:
  // Nodes go to `table`, which must outlive the descent.
  Descent(const Grid& grid, const DescentConfig& config, NodeTable* table);

  // The sub-DAG of `cube` (level <= brick level), whose triangles are in `list`.
  SubDag run(const Cube& cube, const EntryList& list);

  const DecisionCounts& decisions() const { return decisions_; }

 private:
  SubDag brick(const Cube& cube, const EntryList& list);
  Brick selected_voxels(const Cube& cube) const;
  bool outside_selection(const Cube& cube) const;

  Grid grid_;
  DescentConfig config_;
  DecisionCounts decisions_;
  NodeTable* table_;
  std::vector<std::array<EntryList, 8>> scratch_;  // per level, reused
};

}  // namespace svdag
