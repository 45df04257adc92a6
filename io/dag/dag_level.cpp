#include "io/dag/dag_level.h"

#include <cmath>

#include "streaming/error.h"

namespace svdag {
namespace {

// The child mask of a node of `level`; for a brick, the mask of its nonempty octants.
uint32_t octants(const DagView& dag, uint32_t level, uint32_t index) {
  if (level < dag.brick_level()) return dag_mask(dag, level, index);
  const uint64_t brick = dag.bricks[index];
  uint32_t mask = 0;
  for (unsigned c = 0; c < 8; ++c) mask |= uint32_t((brick >> (8 * c) & 0xff) != 0) << c;
  return mask;
}

}  // namespace

uint64_t dag_brick_at(const DagView& dag, uint32_t level, uint32_t index) {
  if (level == dag.brick_level()) return dag.bricks[index];
  uint64_t brick = 0;
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, index, c);
    if (child != kNoChild) brick |= uint64_t(octants(dag, level + 1, child)) << (8 * c);
  }
  return brick;
}

Grid level_grid(const Grid& grid, int levels) {
  SVDAG_ASSERT(levels >= kMinLevels && levels <= grid.levels);
  Grid result = grid;
  if (levels < grid.levels) {
    result.kind = Grid::Kind::kBox;
    result.levels = levels;
    result.voxel_size = std::ldexp(grid.voxel_size, grid.levels - levels);
    result.origin = grid.corner();
    result.k0 = LatticePoint(0);
  }
  result.bounded = false;
  result.selection = result.whole();
  return result;
}

}  // namespace svdag
