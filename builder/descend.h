// From a cube and its triangles to the cube's sub-DAG: the octree descent.
//
// Invariant: the list of a cube holds every triangle that touches it (perhaps some that do not,
// never twice the same). Empty space is never visited: a child without triangles ends the descent.
// Nor is the inside of a cube that one triangle covers: the plane memo knows it.
// The result depends on the voxels alone, since only bricks decide and they decide exactly.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "builder/cell.h"
#include "builder/node_table.h"
#include "builder/plane_memo.h"
#include "builder/kernels.h"
#include "io/grid.h"

namespace svdag {

// What the descent may use; the result is the same bits with any of it switched off.
struct DescentConfig {
  Rule rule = Rule::kConservative;
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;    // switch the edges of a triangle off where it covers a cube
  bool plane_memo = true;  // answer covered cubes from a memo; needs `covering`
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
  const PlaneMemoCounts& memo() const { return memo_.counts(); }

 private:
  // The plane of a triangle met in this cell, made when it is first asked for.
  struct KnownPlane {
    const TriangleSetup* triangle = nullptr;
    std::optional<LatticePlane> plane;
  };

  SubDag node(const Cube& cube, const EntryList& list);
  std::optional<SubDag> find_in_memo(const Cube& cube, const TriangleSetup& triangle);
  const std::optional<LatticePlane>& plane_of(const TriangleSetup& triangle);
  SubDag brick(const Cube& cube, const EntryList& list);
  Brick selected_voxels(const Cube& cube) const;
  bool outside_selection(const Cube& cube) const;
  bool inside_selection(const Cube& cube) const;

  Grid grid_;
  DescentConfig config_;
  DecisionCounts decisions_;
  NodeTable* table_;
  PlaneMemo memo_;
  std::array<KnownPlane, 64> planes_;  // direct-mapped by address
  std::vector<std::array<EntryList, 8>> scratch_;  // per level, reused
};

}  // namespace svdag
