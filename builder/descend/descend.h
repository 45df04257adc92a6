// The octree descent: from a cube and its triangles to the cube's sub-DAG.
//
// Invariant: the list of a cube holds every triangle that touches the cube, each once, and possibly
// some that do not touch it. Empty space is never visited: a child without triangles ends the
// descent. A cube that one triangle covers is answered by the plane memo without descending.
// Only bricks decide voxels, and they decide exactly, so the result depends on the voxels alone.
//
// Solid rules: the descent also knows the winding number at each cube's first voxel centre
// (builder/winding/crossing.h). Triangles of the cube change it on the way to its children and
// through its bricks; a cube without triangles is empty or a full node.
//
// Layers (builder/octree/sub_dag_root.h): a cube that several layers touch is descended once, with
// one list that is grouped by layer, and gives a sub-DAG per layer and one of the union. Below it,
// cubes that one layer touches are descended as without layers, and what they give is shared; so
// layers cost only where they meet. A brick's voxels are the OR over its triangles, so the union's
// brick is the OR of the layers' bricks. With the solid rules it is not: the union has a winding
// number of its own, and a layer is also where it has no triangle, but winds around the cube.
// Rejected: the layers one after the other, and the union by recursive OR of their nodes (the upper
// cubes are divided once for each layer).
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
#include "builder/reduce/sub_dag_builder.h"
#include "builder/winding/cell_windings.h"
#include "io/grid.h"

namespace svdag {

// The rule, and the fast paths. Fast paths do not change the result: each can be switched off, and
// tests compare the rest.
struct DescentConfig {
  Rule rule = Rule::kConservative;  // which voxels are set
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;       // switch edges of a triangle off where it covers a cube
  bool plane_memo = true;     // answer covered cubes from a memo; needs `covering`
  double memo_repeats = 0.5;  // contents of a plane must repeat so often to be kept; 0: keep all
  uint64_t memo_bytes = UINT64_MAX;  // of the memo, at most; nor more than 1/32 of the budget
  bool cubes = true;                 // decide the voxels of the last two levels at once
  bool patches = true;               // also cubes with a near-planar patch; needs `plane_memo`
  PatchConditions patch = {};        // for tests: without all of them voxels are wrong
  bool with_union = true;            // also keep the union where several layers are

  OverlapConfig overlap() const { return {kernels, covering}; }
};

class Descent {
 public:
  // Nodes go to `builder`, which must outlive the descent. Cubes in `done` are skipped; null: none.
  Descent(const Grid& grid, const DescentConfig& config, SubDagBuilder* builder,
          const MortonSet* done = nullptr);

  // Bakes `cube` (level <= brick level), whose triangles are in `list`. Cubes must be disjoint. The
  // solid rules need the winding numbers at its first_centre().
  void run(const Cube& cube, const TriangleList& list, const LayerWindings& windings = {});
  // The subject of a cube whose sets are one: no other layer is there, and the union winds like it.
  std::optional<Subject> only_subject(const TriangleList& list,
                                      const LayerWindings& windings) const;
  // The winding numbers at the first_centre() of `to`, in the cube `from` of the other arguments.
  LayerWindings windings_at(const Cube& to, const Cube& from, const TriangleList& list,
                            const LayerWindings& windings) const;
  // Adds `cube`, whose sub-DAGs were reduced to the builder's table otherwise.
  using SubjectDags = std::vector<SubjectDag>;
  void adopt(const Cube& cube, SubjectDags dags);

  const DecisionCounts& decisions() const { return decisions_; }
  const PlaneMemoCounts& memo() const { return memo_.counts(); }
  // [level]: number of cubes divided; the other non-empty cubes were answered by the memo.
  const std::vector<uint64_t>& divided() const { return divided_; }

 private:
  // A triangle of this cell that was looked up in the memo, and the result.
  struct Admitted {
    const TriangleSetup* triangle = nullptr;
    std::optional<PlaneMemo::AdmittedPlane> known;
  };

  // What a cube needs: nothing, or to be descended, its children as roots since some are done.
  enum class Need { kNothing, kAll, kRest };
  Need need_of(const Cube& cube, bool is_empty) const;
  void pause_at(const Cube& cube);
  SubDag node(const Cube& cube, const TriangleList& list, int32_t winding);
  SubDag divide(const Cube& cube, const TriangleList& list, int32_t winding, bool as_roots);
  SubDag full(const Cube& cube, int32_t winding, Need need);
  // The same for a cube of several layers.
  void node(const Cube& cube, const TriangleList& list, const LayerWindings& windings,
            SubjectDags* dags);
  void divide(const Cube& cube, const TriangleList& list, const LayerWindings& windings,
              bool as_roots, SubjectDags* dags);
  bool find_in_memo(const Cube& cube, const TriangleList& list, const LayerWindings& windings,
                    SubjectDags* dags);
  void bricks(const Cube& cube, const TriangleList& list, const LayerWindings& windings,
              SubjectDags* dags);
  void add_full(const Cube& cube, const TriangleList& list, const LayerWindings& windings,
                SubjectDags* dags);
  void end(const Cube& cube, SubjectDags dags);
  void update_memo(SubDagBuilder::Pause pause);
  // `sheets`: of the set (builder/winding/crossing.h).
  std::optional<SubDag> find_in_memo(const Cube& cube, const TriangleList& list, int32_t winding,
                                     uint32_t sheets);
  std::optional<SubDag> find_patch(const Cube& cube, const TriangleList& list, int32_t winding,
                                   uint32_t sheets);
  FilledSides filled_sides(const Cube& cube, const TriangleList& list, const LatticePlane& plane,
                           int32_t winding, uint32_t sheets) const;
  const std::optional<PlaneMemo::AdmittedPlane>& admitted(const TriangleSetup& triangle);
  Brick voxels_of(const Cube& cube, std::span<const ListedTriangle> list, int32_t winding,
                  uint32_t sheets);
  SubDag brick(Brick voxels);
  SubDag eight_bricks(const Cube& cube, const TriangleList& list);
  Brick selected_voxels(const Cube& cube) const;

  Grid grid_;
  DescentConfig config_;
  SubDagBuilder* builder_;
  NodeTable* table_;  // of the builder
  FullNodes full_;
  PlaneMemo memo_;
  std::array<Admitted, 64> admitted_;  // direct-mapped, see admitted()
  double cell_side_ = 0;               // of the cell being baked, in voxels

  const MortonSet* done_;                           // null: nothing
  bool partly_done_ = false;                        // a part of the cell being baked is in done_
  std::vector<std::array<TriangleList, 8>> lists_;  // [level], reused
  std::vector<SubjectDags> dags_;                   // [level], reused
  std::vector<uint64_t> divided_;
  DecisionCounts decisions_;
};

}  // namespace svdag
