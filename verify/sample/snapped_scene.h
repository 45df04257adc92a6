// The scene as the judge sees it: triangles snapped to the lattice of the file's grid, streamed.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "io/grid.h"
#include "io/scene/scene.h"

namespace svdag {

struct SnapCounts {
  SceneCounts scene;
  uint64_t outside = 0;     // triangles whose box misses the closed grid: they set nothing
  double largest_move = 0;  // by the snap, in voxels, of those whose box meets the selection
};

using SnappedSink = std::function<void(std::span<const LatticeTriangle>)>;

// Passes every triangle of `scene` whose box meets the closed grid to the sink, in batches.
SnapCounts stream_snapped(const Scene& scene, const Grid& grid, const SnappedSink& sink);

// What a comparison of the file's grid with the scene's bounds says.
struct GridJudgement {
  std::vector<std::string> defects;  // empty: the grid holds the scene
  bool recomputed = false;           // the same grid follows from the scene's bounds
};

// What is wrong with the largest move that a file says of its scene; empty if nothing is. 0 is
// taken for no claim: imports, which were made of no triangles, have it.
std::string snap_defect(double said, const SnapCounts& whole_scene);

// `bounds` are those of the vertices that triangles use, found by the judge itself.
GridJudgement judge_grid(const Grid& grid, const Box& bounds);

}  // namespace svdag
