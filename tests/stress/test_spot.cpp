#include "tests/stress/test_spot.h"

#include <algorithm>

namespace svdag {
namespace {

// A coordinate in 0 .. bound-1.
int64_t draw_coordinate(int64_t bound, SpotArea area, StressRandom* random) {
  switch (area) {
    case SpotArea::kBorder:
      return random->coin() ? 0 : bound - 1;
    case SpotArea::kMiddle:
      return std::clamp<int64_t>(bound / 2 - random->between(0, 1), 0, bound - 1);
    default:
      return random->between(0, bound - 1);
  }
}

}  // namespace

Spot draw_spot(const Grid& grid, int depth, int64_t side, SpotArea area, StressRandom* random) {
  Spot spot;
  spot.grid = grid;
  spot.start.level = depth;
  const int64_t cube = grid.resolution() >> depth;  // side of the start in voxels
  const int64_t region = std::min(side, cube);
  const int free_axis = random->axis();  // a border has faces, not only corners
  for (int a = 0; a < 3; ++a) {
    const SpotArea here = area == SpotArea::kBorder && a == free_axis ? SpotArea::kAnywhere : area;
    spot.start.coordinate[a] = draw_coordinate(int64_t(1) << depth, here, random);
    const int64_t low = spot.start.coordinate[a] * cube, room = cube - region;
    int64_t at = random->between(0, room);
    if (here == SpotArea::kMiddle) at = grid.resolution() / 2 - region / 2 - low;
    if (here == SpotArea::kBorder) at = low == 0 ? 0 : room;
    // A quarter of the regions are at a border of the start cube on this axis.
    if (here == SpotArea::kAnywhere && random->below(4) == 0) at = random->coin() ? 0 : room;
    spot.region.min[a] = low + std::clamp<int64_t>(at, 0, room);
    spot.region.max[a] = spot.region.min[a] + region;
  }
  return spot;
}

Grid unit_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.voxel_size = 1;
  grid.selection = grid.whole();
  return grid;
}

}  // namespace svdag
