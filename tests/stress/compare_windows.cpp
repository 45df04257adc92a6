#include "tests/stress/compare_windows.h"

#include <algorithm>

#include "tests/stress/centre_lines.h"
#include "tests/stress/paths.h"
#include "verify/judge/centre_lines.h"
#include "verify/judge/clip_judge.h"

namespace svdag {
namespace {

// Whether every triangle is small, so that a descent over the whole start cube is cheap.
bool all_small(const Spot& spot, std::span<const LatticeTriangle> triangles) {
  for (const LatticeTriangle& t : triangles) {
    for (int a = 0; a < 3; ++a) {
      const auto [low, high] = std::minmax({t.v[0][a], t.v[1][a], t.v[2][a]});
      if (high - low > 24 * spot.voxel()) return false;
    }
  }
  return true;
}

}  // namespace

Tally& Tally::operator+=(const Tally& other) {
  decisions += other.decisions;
  misses += other.misses;
  extras += other.extras;
  return *this;
}

VoxelRegion voxelized(const Spot& spot, const DescentConfig& config,
                      std::span<const LatticeTriangle> triangles, uint64_t* outside) {
  Grid grid = spot.grid;
  // The parity of the region's corner is a random choice, so small triangles are tested in both
  // ways.
  const bool whole = all_small(spot, triangles) && (spot.region.min.x & 1) == 0 &&
                     !is_solid(config.rule);  // a start cube inside may have any number of bricks
  if (!whole) {
    grid.bounded = true;
    grid.selection = spot.region;
  }
  VoxelRegion region(spot.region);
  uint64_t elsewhere = 0;
  voxelize_window(grid, config, spot.start, triangles,
                  [&](const LatticePoint& at, Brick b) { elsewhere += region.set_brick(at, b); });
  if (outside != nullptr && !whole) *outside += elsewhere;
  return region;
}

VoxelRegion judged(const Spot& spot, Rule rule, std::span<const LatticeTriangle> triangles) {
  VoxelRegion region(spot.region);
  const LatticePoint sides = spot.region.max - spot.region.min;
  const auto place = [&](const LatticePoint& voxel) {
    const LatticePoint p = voxel - spot.region.min;
    return size_t((p.x * sides.y + p.y) * sides.z + p.z);
  };
  std::vector<int32_t> windings(is_solid(rule) ? place(spot.region.max) : 0);  // changes along z
  Clipper clipper;
  for (const LatticeTriangle& t : triangles) {
    if (rule == Rule::kThin) {
      add_thin_voxels(t, spot.grid.fraction(), &region);
      continue;
    }
    if (is_solid(rule)) {
      winding_changes(
          t, spot.grid.fraction(), spot.region,
          [&](const LatticePoint& voxel, int change) { windings[place(voxel)] += change; });
    }
    clipper.run(t, spot.grid.fraction(), spot.region, [&](const CellRun& run) {
      LatticePoint voxel = run.first;
      for (int64_t i = 0; i < run.count; ++i, ++voxel[run.axis]) region.set(voxel);
    });
  }
  if (!is_solid(rule)) return region;
  LatticePoint at = spot.region.min;
  for (; at.x < spot.region.max.x; ++at.x) {
    for (at.y = spot.region.min.y; at.y < spot.region.max.y; ++at.y) {
      int32_t winding = 0;
      for (at.z = spot.region.min.z; at.z < spot.region.max.z; ++at.z) {
        winding += windings[place(at)];
        if (is_inside(rule, winding)) region.set(at);
      }
    }
  }
  return region;
}

Tally compare_window(const Spot& spot, Rule rule, std::span<const LatticeTriangle> triangles) {
  static const std::vector<DescentPath> kPaths = descent_paths();
  static size_t turn = 0;
  Tally tally;
  DescentConfig other = kPaths[turn++ % kPaths.size()].config;
  other.rule = rule;
  const VoxelRegion ours = voxelized(spot, {.rule = rule}, triangles, &tally.extras);
  const VoxelRegion others = voxelized(spot, other, triangles, &tally.extras);
  const VoxelRegion truth = judged(spot, rule, triangles);
  const VoxelRegion surface =
      rule == Rule::kConservative ? truth : judged(spot, Rule::kConservative, triangles);
  tally.decisions = surface.dilated().count();
  tally.misses = truth.count_without(ours) + truth.count_without(others);
  tally.extras += ours.count_without(truth) + others.count_without(truth);
  return tally;
}

}  // namespace svdag
