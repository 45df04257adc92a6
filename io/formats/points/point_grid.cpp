#include "io/formats/points/point_grid.h"

#include <algorithm>
#include <cmath>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The cells of axis `a`: of the lattice through zero, or of the grid's box.
ExactCell cells_of(const PointInput& input, int a, double corner, double size) {
  const PointSummary& summary = input.summary;
  const double max_point = std::max(std::abs(summary.min[a]), std::abs(summary.max[a]));
  return {input.cloud->scale[a], input.cloud->offset[a], corner, size, max_point};
}

// The first and the last cell with points.
struct CellRange {
  int64_t first = INT64_MAX, last = INT64_MIN;
};
// Nothing if a cell is not exact, since `max_reach` is exceeded.
std::optional<CellRange> range_of(std::span<const PointInput> inputs, int a, double corner,
                                  double size, double max_reach) {
  CellRange range;
  for (const PointInput& input : inputs) {
    if (input.summary.empty()) continue;
    const ExactCell cells = cells_of(input, a, corner, size);
    if (!(cells.reach() < max_reach)) return std::nullopt;
    for (const double end : {input.summary.min[a], input.summary.max[a]}) {
      range.first = std::min(range.first, cells.of(end));
      range.last = std::max(range.last, cells.of(end));
    }
  }
  return range;
}

void require_size(double size) {
  if (!(std::isnormal(size) && size >= 1 / PointCloud::kMaxMagnitude &&
        size <= PointCloud::kMaxMagnitude))
    fail_usage("-s: " + format_double(size) + " is not a voxel size from 1e-60 to 1e60");
}

Grid lattice_of(std::span<const PointInput> inputs, double size) {
  require_size(size);
  Grid grid;
  grid.kind = Grid::Kind::kOrigin;
  grid.voxel_size = size;
  std::array<CellRange, 3> ranges;
  for (int a = 0; a < 3; ++a) {
    const auto range = range_of(inputs, a, 0, size, 0x1p38);
    if (!range)
      fail_usage("-s: the points are more than 2^38 voxels away from zero: choose larger voxels");
    ranges[size_t(a)] = *range;
  }
  for (grid.levels = kMinLevels; grid.levels <= kMaxLevels; ++grid.levels) {
    bool fits = true;
    for (int a = 0; a < 3; ++a) {
      const auto [first, last] = ranges[size_t(a)];
      grid.k0[a] = first & -corner_step(grid.levels);
      fits = fits && last - grid.k0[a] < grid.resolution();
    }
    if (fits) return grid;
  }
  fail_usage("-s: the points need more than 1M voxels on an axis: choose larger voxels");
}

Grid box_of_points(std::span<const PointInput> inputs, int levels) {
  Box box;
  for (const auto& [path, cloud, summary] : inputs) {
    if (summary.empty()) continue;
    for (const Point& p : {summary.min, summary.max}) box.add(p * cloud->scale + cloud->offset);
  }
  if (box.min == box.max) fail_usage("-r: all points are at one place: give -s instead");
  const Grid grid = divide_box(box, levels);
  require_size(grid.voxel_size);
  if (!holds(grid, inputs))
    fail_usage("-r: voxels of " + format_double(grid.voxel_size) +
               " are below the precision of the coordinates: choose a lower resolution");
  return grid;
}

}  // namespace

PointSummary summarize(const PointCloud& cloud, const std::string& path) {
  PointSummary summary;
  summary.left_out = cloud.read([&](const PointBatch& batch) {
    check_interrupt();
    if (summary.empty()) summary.min = summary.max = batch.points.front();
    summary.count += batch.points.size();
    for (const Point& p : batch.points) {
      summary.min = glm::min(summary.min, p);
      summary.max = glm::max(summary.max, p);
    }
    for (const PointColour& colour : batch.colours)
      summary.brightest = std::max({summary.brightest, colour[0], colour[1], colour[2]});
    for (const uint8_t number : batch.classes) summary.classes.set(number);
    for (const Point& p : {summary.min, summary.max})
      for (int a = 0; a < 3; ++a)
        if (!(std::abs(p[a]) <= PointCloud::kMaxMagnitude))
          fail_input(path, "has a coordinate beyond 1e60");
  });
  return summary;
}

bool holds(const Grid& grid, std::span<const PointInput> inputs) {
  for (int a = 0; a < 3; ++a) {
    const auto range = range_of(inputs, a, grid.origin[a], grid.voxel_size, ExactCell::kMaxReach);
    if (!range || range->first < 0 || range->last >= grid.resolution()) return false;
  }
  return true;
}

Grid grid_of_points(std::span<const PointInput> inputs, const std::optional<double>& voxel_size,
                    int levels) {
  Grid grid = voxel_size ? lattice_of(inputs, *voxel_size) : box_of_points(inputs, levels);
  grid.selection = grid.whole();
  return grid;
}

PointCells::PointCells(const PointInput& input, const Grid& grid)
    : axes_{cells_of(input, 0, grid.origin[0], grid.voxel_size),
            cells_of(input, 1, grid.origin[1], grid.voxel_size),
            cells_of(input, 2, grid.origin[2], grid.voxel_size)},
      first_(grid.k0) {}

}  // namespace svdag
