// The octree descent: from a cube and its triangles to the cube's sub-DAG.
//
// Invariant: the list of a cube holds every triangle that touches the cube, each once, and possibly
// some that do not touch it. Empty space is never visited: a child without triangles ends the
// descent. A cube that one triangle covers is answered by the plane memo without descending.
// Only bricks decide voxels, and they decide exactly, so the result depends only on the voxels.
//
// Solid rules: the descent also knows the winding number at each cube's first voxel centre
// (builder/winding/crossing.h). Triangles of the cube change it on the way to its children and
// through its bricks; a cube without triangles is empty or a full node.
//
// Layers (builder/octree/subject.h): a cube that several layers touch is descended once, with one
// list that is grouped by layer, and gives a sub-DAG per layer and one of the union. Below it, a
// cube that only one layer touches has one set of voxels, as every cube has in a bake without
// layers; so layers cost only where they meet. A brick's voxels are the OR over its triangles, so
// the union's brick is the OR of the layers' bricks. With the solid rules it is not: the union has
// a winding number of its own, and a layer is also where it has no triangle, but winds around the
// cube.
// Cut-outs (io/scene/cutouts/): where a cut triangle is transparent in a cube, it leaves the list;
// where it is opaque, it is as any other from there on; what is left is divided, and its voxels are
// decided one by one, by its opaque points. No memo and no fast path knows a list with such a
// triangle.
// Rejected: the layers one after the other, and the union by recursive OR of their nodes (the upper
// cubes are divided once for each layer).
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
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
#include "io/scene/cutouts/cut_records.h"
#include "io/scene/cutouts/cut_triangle.h"

namespace svdag {

// They do not change the result: each can be switched off, and tests compare the rest.
struct FastPaths {
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;       // switch edges of a triangle off where it covers a cube
  bool plane_memo = true;     // answer covered cubes from a memo; needs `covering`
  double memo_repeats = 0.5;  // contents of a plane must repeat so often to be kept; 0: keep all
  uint64_t memo_bytes = UINT64_MAX;  // of the memo, at most; nor more than 1/32 of the budget
  bool cubes = true;                 // decide the voxels of the last two levels at once
  bool patches = true;               // also cubes with a near-planar patch; needs `plane_memo`
  PatchConditions patch = {};        // for tests: without all of them voxels are wrong

  OverlapConfig overlap() const { return {kernels, covering}; }
};

struct DescentConfig : FastPaths {
  Rule rule = Rule::kConservative;    // which voxels are set
  const CutOuts* cut_outs = nullptr;  // of the materials; null: no triangle is cut
};

struct DescentCounts {
  DecisionCounts decisions;
  PlaneMemoCounts memo;
  // [level]: number of cubes divided; the other non-empty cubes were answered by the memo.
  std::vector<uint64_t> divided;

  DescentCounts& operator+=(const DescentCounts& other);
};

// A sub-DAG and the sets that share it.
struct SetsDag {
  SubDagSets sets;
  SubDag dag;
};

class Descent {
 public:
  // Nodes go to `builder`, which must outlive the descent. Cubes in `done` are skipped; null: none.
  Descent(const Grid& grid, const DescentConfig& config, SubDagBuilder* builder,
          const MortonSet* done = nullptr);

  // The records of the cut-out triangles of the cubes from here on, which must outlive them.
  void use(const CutRecords* cuts) { cuts_ = cuts; }
  // Bakes `cube` (level <= brick level), whose triangles are in `list`. Cubes must be disjoint. The
  // solid rules need the winding numbers at its first_centre().
  void run(const Cube& cube, const TriangleList& list, const LayerWindings& windings = {});
  // The sets of a cube that has one sub-DAG: only one layer is there, and the union winds like it.
  // Nullopt if it may have several.
  std::optional<SubDagSets> shared_sets(const TriangleList& list,
                                        const LayerWindings& windings) const;
  // The winding numbers at the first_centre() of `to`, in the cube `from` of the other arguments.
  LayerWindings windings_at(const Cube& to, const Cube& from, const TriangleList& list,
                            const LayerWindings& windings) const;
  // Adds `cube`, whose sub-DAGs were reduced to the builder's table otherwise.
  void add_reduced(const Cube& cube, std::span<const SetsDag> dags);

  DescentCounts counts() const;

 private:
  // A triangle of this cell that was looked up in the memo, and the result.
  struct KnownTriangle {
    const TriangleSetup* triangle = nullptr;
    std::optional<PlaneMemo::AdmittedPlane> plane;
  };
  // A cut triangle of this cell, and how it lies in its texture.
  struct KnownCut {
    const TriangleSetup* triangle = nullptr;
    std::optional<CutPlane> plane;
  };
  // The sets of voxels in a cube. If they share a sub-DAG, the cube is descended for the union's
  // triangles and winding number, which are theirs.
  struct CubeSets {
    std::optional<SubDagSets> shared;
    LayerWindings windings;  // at first_centre()
  };

  // What a cube needs: nothing, or to be descended, its children as roots since some are done.
  enum class Need { kNothing, kAll, kRest };
  Need need_of(const Cube& cube, const TriangleList& list, const LayerWindings& windings) const;
  // Calls visit(subject, triangles, winding) for each set, by subject.
  template <class Visit>
  static void for_each_set(const TriangleList& list, const CubeSets& sets, const Visit& visit);
  void pause_at(const Cube& cube);
  // Cut-outs (builder/descend/cut_list.cpp).
  void settle_cuts(const Cube& cube, TriangleList* list);
  const TriangleSetup* whole(const TriangleSetup* triangle);
  const CutPlane& cut_plane(const TriangleSetup* triangle);
  Brick opaque_voxels(const ListedTriangle& entry, const LatticePoint& corner, Brick wanted);
  void node(const Cube& cube, const TriangleList& list, const CubeSets& sets);
  void divide(const Cube& cube, const TriangleList& list, const CubeSets& sets, bool as_roots);
  void eight_bricks(const Cube& cube, const TriangleList& list, const CubeSets& sets);
  void brick(const Cube& cube, const TriangleList& list, const CubeSets& sets);
  // Adds the sets that have no triangle in the cube and wind around it.
  void add_full(const Cube& cube, const TriangleList& list, const CubeSets& sets);
  void add(const Cube& cube, const CubeSets& sets, Subject subject, const SubDag& dag);
  void add_brick(const Cube& cube, const CubeSets& sets, Subject subject, Brick voxels);
  void update_memo(SubDagBuilder::Pause pause);
  // Whether the memo knows the sub-DAG of every set; adds them.
  bool find_in_memo(const Cube& cube, const TriangleList& list, const CubeSets& sets);
  // `sheets`: of the set (builder/winding/crossing.h).
  std::optional<SubDag> find_set(const Cube& cube, std::span<const ListedTriangle> list,
                                 int32_t winding, uint32_t sheets);
  std::optional<SubDag> find_patch(const Cube& cube, std::span<const ListedTriangle> list,
                                   int32_t winding, uint32_t sheets);
  FilledSides filled_sides(const Cube& cube, std::span<const ListedTriangle> list,
                           const LatticePlane& plane, int32_t winding, uint32_t sheets) const;
  const std::optional<PlaneMemo::AdmittedPlane>& known_plane(const TriangleSetup& triangle);
  Brick voxels_of(const Cube& cube, std::span<const ListedTriangle> list, int32_t winding,
                  uint32_t sheets);

  Grid grid_;
  DescentConfig config_;
  RuleKernels voxels_;  // of the rule
  SubDagBuilder* builder_;
  NodeTable* table_;  // of the builder
  FullNodes full_;
  PlaneMemo memo_;
  std::array<KnownTriangle, 64> known_;  // direct-mapped, see known_plane()
  double cell_side_ = 0;                 // of the cell being baked, in voxels

  const CutRecords* cuts_ = nullptr;
  // Of cut triangles of this cell: as they are where all of them is opaque.
  std::unordered_map<const TriangleSetup*, std::unique_ptr<TriangleSetup>> whole_;
  std::vector<KnownCut> known_cuts_;  // direct-mapped, see cut_plane()

  const MortonSet* done_;                           // null: nothing
  bool partly_done_ = false;                        // a part of the cell being baked is in done_
  std::vector<std::array<TriangleList, 8>> lists_;  // [level], reused
  std::vector<std::array<CubeSets, 8>> sets_;       // [level], reused
  std::vector<std::pair<Subject, SubDag>> found_;   // in the memo, reused
  DescentCounts counts_;                            // without those of memo_
};

}  // namespace svdag
