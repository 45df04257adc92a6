// The grid of a point cloud, and the voxels of its points on it.
//
// The first pass over a file finds the box of its points; the header's box is not trusted. The
// second maps each point to the one half-open voxel [k, k+1) that holds it, on each axis exactly.
//
// With a voxel size S, planes are at k * S (kind kOrigin, O = 0), whatever the points, so clouds of
// one S agree. Else the grid divides the box of the points (divide_box of io/grid.h).
#pragma once

#include <bitset>
#include <optional>
#include <string>

#include "io/formats/points/exact_cell.h"
#include "io/formats/points/point_cloud.h"
#include "io/grid.h"
#include "io/voxel_source.h"

namespace svdag {

// What the first pass finds.
struct PointSummary {
  uint64_t count = 0;
  uint64_t left_out = 0;
  Point min{0}, max{0};      // before scale and offset; of all points
  uint16_t brightest = 0;    // channel
  std::bitset<256> classes;  // that occur
  bool empty() const { return count == 0; }
};

// Error (kBadInput) if there are no points.
PointSummary summarize(const PointCloud& cloud, const std::string& path);

// `voxel_size`: -s; nothing: `levels` instead. Error (kUsage) if the grid would be too large, or
// its voxels too small for the precision of the coordinates.
Grid grid_of_points(const PointCloud& cloud, const PointSummary& summary,
                    const std::optional<double>& voxel_size, int levels, const std::string& path);

// Maps the points of a cloud to voxels of its grid.
class PointCells {
 public:
  PointCells(const PointCloud& cloud, const PointSummary& summary, const Grid& grid);

  Voxel of(const Point& point) const noexcept {
    Voxel voxel;
    for (int a = 0; a < 3; ++a)
      voxel[size_t(a)] = uint32_t(axes_[size_t(a)].of(point[a]) - first_[a]);
    return voxel;
  }

 private:
  std::array<ExactCell, 3> axes_;
  LatticePoint first_;  // plane of the grid's corner
};

// The 8-bit colour of a channel. A file that fills only the lower byte, as some LAS files do, has
// its colours there.
inline Colour colour_of_point(const PointColour& colour, const PointSummary& summary) {
  const int shift = summary.brightest < 256 ? 0 : 8;
  return {uint8_t(colour[0] >> shift), uint8_t(colour[1] >> shift), uint8_t(colour[2] >> shift)};
}

}  // namespace svdag
