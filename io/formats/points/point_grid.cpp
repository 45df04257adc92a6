#include "io/formats/points/point_grid.h"

#include <algorithm>
#include <cmath>

#include "io/units.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The cells of axis `a`: of the lattice through zero, or of the grid's box.
ExactCell cells_of(const PointCloud& cloud, const PointSummary& summary, int a, double corner,
                   double size) {
  const double max_point = std::max(std::abs(summary.min[a]), std::abs(summary.max[a]));
  return {cloud.scale[a], cloud.offset[a], corner, size, max_point};
}

// The first and the last cell with points.
struct CellRange {
  int64_t first, last;
};
CellRange range_of(const ExactCell& cells, const PointSummary& summary, int a) {
  const int64_t low = cells.of(summary.min[a]), high = cells.of(summary.max[a]);
  return {std::min(low, high), std::max(low, high)};  // a scale may be negative
}

void require_size(double size) {
  if (!(std::isnormal(size) && size >= 1 / PointCloud::kMaxMagnitude &&
        size <= PointCloud::kMaxMagnitude))
    fail_usage("-s: " + format_double(size) + " is not a voxel size from 1e-60 to 1e60");
}

Grid lattice_of(const PointCloud& cloud, const PointSummary& summary, double size) {
  require_size(size);
  Grid grid;
  grid.kind = Grid::Kind::kOrigin;
  grid.voxel_size = size;
  std::array<CellRange, 3> ranges;
  for (int a = 0; a < 3; ++a) {
    const ExactCell cells = cells_of(cloud, summary, a, 0, size);
    if (!(cells.reach() < 0x1p38))
      fail_usage("-s: the points are more than 2^38 voxels away from zero: choose larger voxels");
    ranges[size_t(a)] = range_of(cells, summary, a);
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

Grid box_of_points(const PointCloud& cloud, const PointSummary& summary, int levels,
                   const std::string& path) {
  Box box;
  for (const Point& p : {summary.min, summary.max}) box.add(p * cloud.scale + cloud.offset);
  if (box.min == box.max)
    fail_usage("-r: all points of " + path + " are at one place: give -s instead");
  Grid grid = divide_box(box, levels);
  require_size(grid.voxel_size);
  for (int a = 0; a < 3; ++a) {
    const ExactCell cells = cells_of(cloud, summary, a, grid.origin[a], grid.voxel_size);
    bool fits = cells.reach() < ExactCell::kMaxReach;
    if (fits) {
      const auto [first, last] = range_of(cells, summary, a);
      fits = first >= 0 && last < grid.resolution();
    }
    if (!fits)
      fail_usage("-r: voxels of " + format_double(grid.voxel_size) +
                 " are below the precision of the coordinates of " + path +
                 ": choose a lower resolution");
  }
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
  if (summary.empty())
    fail_input(path, "has no points" +
                         (summary.left_out == 0
                              ? std::string()
                              : ": all " + format_count(summary.left_out) + " are left out"));
  return summary;
}

Grid grid_of_points(const PointCloud& cloud, const PointSummary& summary,
                    const std::optional<double>& voxel_size, int levels, const std::string& path) {
  Grid grid = voxel_size ? lattice_of(cloud, summary, *voxel_size)
                         : box_of_points(cloud, summary, levels, path);
  grid.selection = grid.whole();
  return grid;
}

PointCells::PointCells(const PointCloud& cloud, const PointSummary& summary, const Grid& grid)
    : axes_{cells_of(cloud, summary, 0, grid.origin[0], grid.voxel_size),
            cells_of(cloud, summary, 1, grid.origin[1], grid.voxel_size),
            cells_of(cloud, summary, 2, grid.origin[2], grid.voxel_size)},
      first_(grid.k0) {}

}  // namespace svdag
