// Streams the triangles of a scene, snapped to the lattice of the file's grid, to the judge.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/grid.h"
#include "io/scene/cutouts/cut_records.h"
#include "io/scene/scene.h"

namespace svdag {

struct SnapCounts {
  SceneCounts scene;
  uint64_t outside = 0;     // triangles whose box misses the closed grid: they set nothing
  double largest_move = 0;  // by the snap, in voxels, of triangles whose box meets the selection
};

// Gets snapped triangles of a batch.
using SnappedSink = std::function<void(std::span<const LatticeTriangle>, const TriangleBatch&)>;

// Passes every triangle of `scene` whose box meets the closed grid to the sink, in batches; for the
// solid rules, whose winding numbers need them, all triangles, and triangles of open parts as
// sheets. `layer`: the scene is one layer of this kind, unless kNone. *cuts gets the records of
// those that are cut out; null: such a scene is an Error (kUsage).
SnapCounts stream_snapped(const Scene& scene, const Grid& grid, CutScene* cuts,
                          const SnappedSink& sink, Rule rule = Rule::kConservative,
                          LayerKind layer = LayerKind::kNone);

// The result of comparing the file's grid with the scene's bounds.
struct GridJudgement {
  std::vector<std::string> defects;  // empty: the grid holds the scene
  bool recomputed = false;           // true if the scene's bounds give the same grid
};

// The defect of the largest move recorded in a file's header; empty if it is correct. 0 means not
// recorded, as in imports, which have no triangles.
std::string snap_defect(double recorded, const SnapCounts& whole_scene);

// `bounds`: of the vertices that triangles use, computed by the judge itself.
GridJudgement judge_grid(const Grid& grid, const Box& bounds);

}  // namespace svdag
