#include "builder/bake/choose_grid.h"

#include <algorithm>

#include "streaming/error.h"

namespace svdag {

namespace {

Grid place_grid(const BuildConfig& config, const Scene& scene, SceneExtent* extent) {
  if (config.open_as_sheets && config.layers == LayerKind::kFrame)
    fail_usage("--open surface: every frame has to be closed: give --rule conservative or thin");
  if (config.cube && config.voxel_size != 0)
    fail_usage("--cube: the cube is divided by --resolution: give -r instead of -s");
  if (config.origin && config.voxel_size == 0)
    fail_usage("--origin: voxel planes follow from it with -s: give -s instead of -r");
  if (config.cube) {
    const Grid grid = divide_cube(*config.cube, config.levels);
    return config.bounds ? select_bounds(grid, *config.bounds) : grid;
  }
  if (!config.bounds) extent->bounds = scene.bounds(&extent->counts);
  const Box target = config.bounds ? *config.bounds : *extent->bounds;
  const Grid grid = config.voxel_size != 0 ? cover_lattice(target, config.voxel_size, config.origin)
                                           : divide_box(target, config.levels);
  return config.bounds ? select_bounds(grid, *config.bounds) : grid;
}

}  // namespace

Grid choose_grid(const BuildConfig& config, const Scene& scene, SceneExtent* extent) {
  SceneExtent unused;
  Grid grid = place_grid(config, scene, extent != nullptr ? extent : &unused);
  grid.transform = config.scene.to_world();
  return grid;
}

// 64 cells along the grid, of at least 64 voxels: enough cells to share out, few enough to be
// cheap. Where memory is so little that their list would matter, 32.
int choose_cell_level(const BuildConfig& config, const Grid& grid, uint64_t memory) {
  // Winding numbers are known at cubes of a level, and lists of triangles from the cells down.
  const int finest =
      is_solid(config.rule) ? CellWindings::level_of_grid(grid.levels) : grid.levels - 2;
  if (config.cell_level >= 0) return std::min(config.cell_level, finest);
  return std::clamp(grid.levels - 6, 0, memory < uint64_t(512) << 20 ? 5 : 6);
}

}  // namespace svdag
