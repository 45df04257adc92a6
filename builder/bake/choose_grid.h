// What a configuration leaves open: the grid and its cells.
#pragma once

#include <optional>

#include "builder/build.h"

namespace svdag {

// What a pass over the scene finds.
struct SceneExtent {
  SceneCounts counts;
  std::optional<Box> bounds;
};

// The grid of `config`. Reads the scene's extent, into `extent` if given, unless --bounds or --cube
// replaces it. Error (kUsage) if the options contradict each other.
Grid choose_grid(const BuildConfig& config, const Scene& scene, SceneExtent* extent = nullptr);

// The octree level of the cells of `grid`, in so much memory.
int choose_cell_level(const BuildConfig& config, const Grid& grid, uint64_t memory);

}  // namespace svdag
