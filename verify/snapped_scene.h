// The scene as the judge sees it: triangles snapped to the lattice of the file's grid, streamed.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "io/grid.h"
#include "io/scene/scene.h"

namespace svdag {

struct SnapCounts {
  SceneCounts scene;
  uint64_t outside = 0;     // triangles whose box misses the closed grid: they set nothing
  double largest_move = 0;  // by the snap, in voxels
};

using SnappedSink = std::function<void(std::span<const LatticeTriangle>)>;

// Hands on, in batches, every triangle of `scene` whose box meets the closed grid.
SnapCounts stream_snapped(const Scene& scene, const Grid& grid, const SnappedSink& sink);

// What a comparison of the file's grid with the scene's bounds says.
struct GridJudgement {
  std::vector<std::string> defects;  // empty: the grid holds the scene
  bool recomputed = false;           // the same grid follows from the scene's bounds
};

// `bounds` are those of the vertices that triangles use, found by the judge itself.
GridJudgement judge_grid(const Grid& grid, const Box& bounds);

}  // namespace svdag
