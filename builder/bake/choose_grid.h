// What a configuration leaves open: the grid and its cells.
#pragma once

#include "builder/build.h"

namespace svdag {

// The grid of `config`. Reads the scene's bounds, and its counts into `counts` if given, unless
// --bounds or --cube replaces them. Error (kUsage) if the options contradict each other.
Grid choose_grid(const BuildConfig& config, const Scene& scene, SceneCounts* counts = nullptr);

// The octree level of the cells of `grid`, in so much memory.
int choose_cell_level(const BuildConfig& config, const Grid& grid, uint64_t memory);

}  // namespace svdag
