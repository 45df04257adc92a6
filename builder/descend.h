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
#include "builder/kernels.h"
#include "builder/node_table.h"
#include "builder/patch.h"
#include "builder/plane_memo.h"
#include "io/grid.h"

namespace svdag {

// What the descent may use; the result is the same bits with any of it switched off.
struct DescentConfig {
  Rule rule = Rule::kConservative;
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;        // switch the edges of a triangle off where it covers a cube
  bool plane_memo = true;      // answer covered cubes from a memo; needs `covering`
  double memo_repeats = 0.5;     // contents of a plane must repeat so often to be kept; 0: keep all
  bool patches = true;         // also cubes with a near-planar patch; needs `plane_memo`
  PatchConditions patch = {};  // for tests: all are needed
};

// Divides `list`, the list of `cube`, among its children.
void divide_list(const EntryList& list, const Cube& cube, int levels, const DescentConfig& config,
                 std::array<EntryList, 8>* children);

class Descent {
 public:
  // Nodes go to `table`, which must outlive the descent.
  Descent(const Grid& grid, const DescentConfig& config, NodeTable* table);

  // Bakes `cube` (level <= brick level), whose triangles are in `list`; if a voxel is set there,
  // its sub-DAG joins roots(). Cubes must be disjoint.
  void run(const Cube& cube, const EntryList& list);
  // Settles all handles; nothing may run after this.
  void finish();

  // The cubes that are not empty; after finish(), root - 1 is a number.
  struct Root {
    Cube cube;
    SubDag dag;
  };
  const std::vector<Root>& roots() const { return roots_; }

  const DecisionCounts& decisions() const { return decisions_; }
  const PlaneMemoCounts& memo() const { return memo_.counts(); }
  // [level]: how many cubes were divided; the others that are not empty were answered by the memo.
  const std::vector<uint64_t>& divided() const { return divided_; }

 private:
  // What the memo said of a triangle in this cell, when it was first asked.
  struct Admitted {
    const TriangleSetup* triangle = nullptr;
    std::optional<PlaneMemo::Known> known;
  };

  SubDag node(const Cube& cube, const EntryList& list);
  std::optional<SubDag> find_in_memo(const Cube& cube, const EntryList& list);
  std::optional<SubDag> find_patch(const Cube& cube, const EntryList& list);
  const std::optional<PlaneMemo::Known>& admitted(const TriangleSetup& triangle);
  SubDag brick(const Cube& cube, const EntryList& list);
  Brick selected_voxels(const Cube& cube) const;
  bool outside_selection(const Cube& cube) const;
  bool inside_selection(const Cube& cube) const;

  Grid grid_;
  DescentConfig config_;
  DecisionCounts decisions_;
  NodeTable* table_;
  PlaneMemo memo_;
  std::array<Admitted, 64> admitted_;  // direct-mapped by address
  double cell_side_ = 0;               // of the cell being baked, in voxels
  void flush(int level);

  std::vector<std::array<EntryList, 8>> scratch_;  // per level, reused
  std::vector<uint64_t> divided_;
  std::vector<NodeKey> path_;  // [level]: children (1 + handle) of the cube being divided there
  std::vector<Root> roots_;
  size_t settled_roots_ = 0;  // roots_ before this one hold numbers
};

}  // namespace svdag
