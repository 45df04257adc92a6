// What a configuration leaves open: the grid and its cells.
#pragma once

#include "builder/build.h"

namespace svdag {

// The grid of `config` for a scene with bounding box `box`.
Grid choose_grid(const BuildConfig& config, const Box& box);

// The octree level of the cells of `grid`, in so much memory.
int choose_cell_level(const BuildConfig& config, const Grid& grid, uint64_t memory);

}  // namespace svdag
