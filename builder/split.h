// First phase: the scene, streamed once, snapped to the lattice and sorted into cells.
#pragma once

#include "builder/cell_tree.h"
#include "io/scene/scene.h"

namespace svdag {

struct SplitCounts {
  SceneCounts scene;
  uint64_t clipped = 0;     // kept, but reaching outside the grid or the selection
  uint64_t outside = 0;     // triangles whose box misses the grid: dropped
  uint64_t degenerate = 0;  // of the others: zero area after the snap
  double largest_snap = 0;  // in voxels, over the triangles that were kept
};

// Fills `tree` and seals it.
SplitCounts split(const Scene& scene, CellTree* tree);

}  // namespace svdag
