// The points of a file, streamed in batches, as often as wanted.
//
// A coordinate p of a batch is the exact rational p * scale + offset of its axis. LAS files
// hold integers p with a scale and an offset; in other formats scale is 1 and offset 0. The product
// is never rounded: exact_cell.h finds the voxel of the rational. Rejected: world coordinates in
// double, which move a point on a plane between voxels to either side of it.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "io/grid.h"

namespace svdag {

// 16 bits a channel; a channel v of 8 bits is v * 257.
using PointColour = std::array<uint16_t, 3>;

struct PointBatch {
  std::span<const Point> points;
  std::span<const PointColour> colours;  // one for each point, or empty
  std::span<const uint8_t> classes;      // the same
};
using PointSink = std::function<void(const PointBatch&)>;

class PointCloud {
 public:
  // Beyond this, products are not exact in exact_cell.h. Smaller scales than the inverse neither.
  static constexpr double kMaxMagnitude = 1e60;

  PointCloud() = default;
  PointCloud(const PointCloud&) = delete;
  PointCloud& operator=(const PointCloud&) = delete;
  virtual ~PointCloud() = default;

  // Passes all points, in file order. Error (kBadInput) if one is infinite or beyond
  // kMaxMagnitude. Points without a position (NaN) and those that a LAS file marks as withheld
  // are left out. Returns their number.
  virtual uint64_t read(const PointSink& sink) const = 0;

  Point scale{1}, offset{0};
  std::optional<Grid> grid;  // of voxels whose centres the points are, if the file has it
  bool has_colours = false;
};

// Collects points into batches.
class PointCollector {
 public:
  explicit PointCollector(const PointSink& sink) : sink_(sink) {}
  // Returns whether the point was added, which then may get a colour and a class: not if a
  // coordinate is NaN.
  bool add(const Point& point) {
    if (!(point.x == point.x && point.y == point.y && point.z == point.z)) {
      ++left_out_;
      return false;
    }
    if (points_.size() == kBatch) flush();
    points_.push_back(point);
    return true;
  }
  void leave_out() { ++left_out_; }
  void add_colour(const PointColour& colour) { colours_.push_back(colour); }
  void add_class(uint8_t number) { classes_.push_back(number); }
  // After the last point: the number of points that were left out.
  uint64_t finish() {
    flush();
    return left_out_;
  }

 private:
  static constexpr size_t kBatch = size_t(1) << 13;

  void flush() {
    if (!points_.empty()) sink_({points_, colours_, classes_});
    points_.clear();
    colours_.clear();
    classes_.clear();
  }

  const PointSink& sink_;
  uint64_t left_out_ = 0;
  std::vector<Point> points_;
  std::vector<PointColour> colours_;
  std::vector<uint8_t> classes_;
};

}  // namespace svdag
