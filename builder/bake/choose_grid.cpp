#include "builder/bake/choose_grid.h"

#include <algorithm>

namespace svdag {

Grid choose_grid(const BuildConfig& config, const Box& box) {
  const Box& target = config.bounds ? *config.bounds : box;
  const Grid grid = config.voxel_size != 0 ? cover_lattice(target, config.voxel_size)
                                           : divide_box(target, config.levels);
  return config.bounds ? select_bounds(grid, *config.bounds) : grid;
}

// 64 cells along the grid, of at least 64 voxels: enough cells to share out, few enough to be
// cheap. Where memory is so little that their list would matter, 32.
int choose_cell_level(const BuildConfig& config, const Grid& grid, uint64_t memory) {
  if (config.cell_level >= 0) return std::min(config.cell_level, grid.levels - 2);
  return std::clamp(grid.levels - 6, 0, memory < uint64_t(512) << 20 ? 5 : 6);
}

}  // namespace svdag
