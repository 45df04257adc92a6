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

#include "builder/descend/patch.h"
#include "builder/descend/plane_memo.h"
#include "builder/octree/morton.h"
#include "builder/octree/morton_set.h"
#include "builder/octree/octree_cube.h"
#include "builder/overlap/kernels/divide_list.h"
#include "builder/overlap/triangle_list.h"
#include "builder/reduce/node_table.h"
#include "io/grid.h"

namespace svdag {

// What the descent decides, and by which ways. The ways give the same bits: each can be switched
// off, and tests hold what is left against the rest.
struct DescentConfig : OverlapConfig {
  Rule rule = Rule::kConservative;  // which voxels are set
  bool plane_memo = true;           // answer covered cubes from a memo; needs `covering`
  double memo_repeats = 0.5;  // contents of a plane must repeat so often to be kept; 0: keep all
  uint64_t memo_bytes = UINT64_MAX;  // of the memo, at most; nor more than 1/32 of the budget
  bool patches = true;               // also cubes with a near-planar patch; needs `plane_memo`
  PatchConditions patch = {};        // for tests: without all of them voxels are wrong
};

class Descent;

// Asked by a descent between two cubes, when nothing but handles is held.
class Spiller {
 public:
  virtual ~Spiller() = default;
  // Whether what the table holds has waited for so long that it shall be flushed, full or not.
  virtual bool late(const NodeTable&) { return false; }
  // Whether `table`, which was flushed, shall be emptied now.
  virtual bool due(const NodeTable& table) = 0;
  // Empties the table; roots(), voxels() and finished() of the descent tell what it held.
  virtual void spill(const Descent& descent) = 0;
};

class Descent {
 public:
  // A cube that is not empty, and 1 + the handle of its sub-DAG.
  struct Root {
    Cube cube;
    uint32_t node;
  };

  // Nodes go to `table`, which must outlive the descent. What is in `done` is left out.
  Descent(const Grid& grid, const DescentConfig& config, NodeTable* table,
          const MortonSet* done = nullptr, Spiller* spiller = nullptr);

  // Bakes `cube` (level <= brick level), whose triangles are in `list`; if a voxel is set there,
  // its sub-DAG joins roots(): as one, or, if the table was emptied meanwhile or a part was done
  // before, as the roots of its parts. Cubes must be disjoint.
  void run(const Cube& cube, const TriangleList& list);
  // Takes `cube`, which was baked by someone else: its sub-DAG is in the table.
  void adopt(const Cube& cube, const SubDag& dag);
  // Nothing stands in `range`: it is finished without being run.
  void note_empty(const MortonRange& range) { append_range(&finished_, range); }
  // Settles all handles.
  void settle() { flush(0); }

  // After settle(), node - 1 is a number of the table.
  const std::vector<Root>& roots() const { return roots_; }
  uint64_t voxels() const { return voxels_; }  // of the roots
  // What was run since the table was emptied last.
  const std::vector<MortonRange>& finished() const { return finished_; }

  const DecisionCounts& decisions() const { return decisions_; }
  const PlaneMemoCounts& memo() const { return memo_.counts(); }
  // [level]: how many cubes were divided; the others that are not empty were answered by the memo.
  const std::vector<uint64_t>& divided() const { return divided_; }

 private:
  // A cube being divided.
  struct Step {
    Cube cube;
    NodeKey children;  // 1 + handle
    uint64_t voxels;   // of these
    bool left_open;    // its children become roots, the cube a node of the top tree
  };

  // What the memo said of a triangle in this cell, when it was first asked.
  struct Admitted {
    const TriangleSetup* triangle = nullptr;
    std::optional<PlaneMemo::Known> known;
  };

  SubDag node(const Cube& cube, const TriangleList& list);
  SubDag divide(const Cube& cube, const TriangleList& list, bool leave_open);
  void begin(const Cube& cube);
  void end(const Cube& cube, const SubDag& dag);
  bool is_flush_due() const;
  void flush(int level);
  void pause(int level, uint64_t reached);
  void spill(int level);
  void make_roots(Step* step);
  std::optional<SubDag> find_in_memo(const Cube& cube, const TriangleList& list);
  std::optional<SubDag> find_patch(const Cube& cube, const TriangleList& list);
  const std::optional<PlaneMemo::Known>& admitted(const TriangleSetup& triangle);
  SubDag brick(const Cube& cube, const TriangleList& list);
  Brick selected_voxels(const Cube& cube) const;

  Grid grid_;
  DescentConfig config_;
  DecisionCounts decisions_;
  NodeTable* table_;
  PlaneMemo memo_;
  std::array<Admitted, 64> admitted_;  // direct-mapped, see admitted()
  double cell_side_ = 0;               // of the cell being baked, in voxels

  const MortonSet* done_;                             // null: nothing
  bool ask_done_ = false;                             // something in the cell being baked is done
  Spiller* spiller_;                                  // null: the table holds everything
  std::vector<std::array<TriangleList, 8>> scratch_;  // per level, reused
  std::vector<uint64_t> divided_;
  std::vector<Step> path_;  // [level]
  int first_level_ = 0;     // of path_ that is in use: the cell's
  std::vector<Root> roots_;
  size_t settled_roots_ = 0;  // roots_ before this one hold numbers
  uint64_t voxels_ = 0;
  std::vector<MortonRange> finished_;
  uint64_t finished_to_ = 0;  // in the cell being baked
};

}  // namespace svdag
