// First phase: the scene, streamed once, snapped to the lattice and sorted into cells.
//
// As long as the triangles fit in their share of memory they stand in one CellTree. When they no
// longer do, all that came and all that comes goes to bins (builder/split/triangle_bins.h).
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/split/cell_tree.h"
#include "builder/split/triangle_bins.h"
#include "io/scene/scene.h"
#include "streaming/process/progress.h"

namespace svdag {

struct SplitConfig {
  int cell_level = 0;
  size_t workers = 1;
  uint64_t triangle_bytes = UINT64_MAX;  // CellTree::bytes() from which on triangles are spilled
  Scratch* scratch = nullptr;            // null: they never are
  const GridPart* part = nullptr;        // triangles that miss it are dropped; null: the whole grid
  // Called once, when the first `read` triangles, dropped ones among them, have become so many
  // bytes in bins, and more will.
  std::function<void(uint64_t read, uint64_t bytes)> on_spill = {};
};

struct SplitCounts {
  SceneCounts scene;
  uint64_t clipped = 0;     // kept, but reaching outside the grid or the selection
  uint64_t outside = 0;     // triangles whose box misses the grid, or the part: dropped
  uint64_t degenerate = 0;  // of the others: zero area after the snap
  double largest_snap = 0;  // in voxels, over the triangles that were kept
};

struct SplitScene {
  SplitCounts counts;
  std::unique_ptr<CellTree> tree;  // sealed; null if the triangles were spilled
  std::vector<TriangleBin> bins;   // in Morton order, in the scratch's `triangles`
};

SplitScene split(const Scene& scene, const Grid& grid, const SplitConfig& config,
                 MemoryBudget* budget);

}  // namespace svdag
