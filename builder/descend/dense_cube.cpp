#include "builder/descend/dense_cube.h"

#include <atomic>
#include <bit>

#include "builder/descend/rules.h"
#include "builder/descend/voxelize_window.h"

namespace svdag {

DenseCube::DenseCube(const Grid& grid, const Cube& cube, const DescentConfig& config,
                     MemoryBudget* budget)
    : grid_(grid), cube_(cube), rule_(config.rule), surface_(config), budget_(budget) {
  const int log2 = grid.levels - cube.level - 2;  // of the side in bricks
  SVDAG_ASSERT(log2 >= 0 && log2 + 2 <= max_side_log2(config.rule));
  const uint64_t bricks = uint64_t(1) << (3 * log2);
  const bool solid = is_solid(config.rule);
  const uint64_t per_brick = sizeof(Brick) + (solid ? 64 * sizeof(int32_t) : 0);
  reservation_ = budget->reserve(bricks * per_brick, "voxels of a dense cube");
  bricks_.assign(bricks, 0);
  if (!solid) return;
  surface_.rule = surface_rule(rule_).rule;
  lines_.emplace(grid.levels, cube, grid.levels);
  steps_.assign(lines_->points(), 0);
}

void DenseCube::add(std::span<const LatticeTriangle> triangles, const CutRecords& cuts,
                    Executor* executor) {
  const size_t parts = executor->workers();
  const uint64_t first = morton(cube_.coordinate) * bricks_.size();
  executor->for_each(parts, [&](size_t, size_t i) {
    const size_t begin = triangles.size() * i / parts, end = triangles.size() * (i + 1) / parts;
    const auto share = triangles.subspan(begin, end - begin);
    voxelize_window(
        grid_, surface_, cube_, share,
        [&](const LatticePoint& at, Brick brick) {
          std::atomic_ref(bricks_[morton(at) - first]).fetch_or(brick, std::memory_order_relaxed);
        },
        budget_, &cuts);
    if (!lines_) return;
    for (const LatticeTriangle& triangle : share) {
      if ((triangle.sheet & sheets_) != 0) continue;
      lines_->for_each_change(triangle, [&](size_t point, int change) {
        std::atomic_ref(steps_[point]).fetch_add(change, std::memory_order_relaxed);
      });
    }
  });
}

void DenseCube::fill(int32_t winding) {
  if (!lines_) return;
  steps_[0] = winding;
  lines_->sum(steps_);
  const uint64_t first = morton(cube_.coordinate) * bricks_.size();
  for (size_t i = 0; i < bricks_.size(); ++i) {
    const LatticePoint corner = unmorton(first + i) * int64_t(kBrickSide);
    for (unsigned bit = 0; bit < 64; ++bit) {
      const auto [x, y, z] = brick_voxel(bit);
      const LatticePoint voxel = corner + LatticePoint(x, y, z);
      const bool selected = !grid_.bounded || grid_.selection.holds({voxel, voxel + int64_t(1)});
      if (selected && is_inside(rule_, steps_[lines_->index(Cube{grid_.levels, voxel})]))
        bricks_[i] |= Brick(1) << bit;
    }
  }
}

SubDag DenseCube::reduce(NodeTable* table) const {
  return reduce(table, cube_, 0);
}

// `first`: where the bricks of `cube` begin.
SubDag DenseCube::reduce(NodeTable* table, const Cube& cube, uint64_t first) const {
  if (cube.level == table->brick_level()) {
    const Brick brick = bricks_[first];
    if (brick == 0) return {};
    return {table->add_brick(brick), uint64_t(std::popcount(brick))};
  }
  NodeKey children{};
  uint64_t voxels = 0;
  const uint64_t step = uint64_t(1) << (3 * (table->brick_level() - cube.level - 1));
  for (unsigned c = 0; c < 8; ++c) {
    const SubDag child = reduce(table, cube.child(c), first + c * step);
    children[c] = child.root;
    voxels += child.voxels;
  }
  if (voxels == 0) return {};
  return {table->add_node(cube.level, children), voxels};
}

}  // namespace svdag
