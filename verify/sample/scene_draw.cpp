#include "verify/sample/scene_draw.h"

#include <algorithm>
#include <cmath>

#include "io/brick.h"
#include "verify/judge/judge_cells.h"
#include "verify/sample/window_triangles.h"

namespace svdag {
namespace {

struct Segment {
  Point from, to;
};

// Clips the segment to the closed box; returns false if nothing remains.
bool cut_segment(const Point& low, const Point& high, Segment* segment) {
  double begin = 0, end = 1;
  const Point from = segment->from, along = segment->to - segment->from;
  for (int a = 0; a < 3; ++a) {
    if (along[a] == 0 && (from[a] < low[a] || from[a] > high[a])) return false;
    if (along[a] == 0) continue;
    const double in = (low[a] - from[a]) / along[a], out = (high[a] - from[a]) / along[a];
    begin = std::max(begin, std::min(in, out));
    end = std::min(end, std::max(in, out));
  }
  if (begin > end) return false;
  *segment = {from + along * begin, from + along * end};
  return true;
}

double length_of(const Point& p) {
  return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

double area_of(const Point& p, const Point& q, const Point& r) {
  const Point a = q - p, b = r - p;
  return 0.5 *
         length_of(Point(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x));
}

// The part of a triangle inside the selection, in voxels.
class ClippedTriangle {
 public:
  ClippedTriangle(const LatticeTriangle& t, const Grid& grid)
      : low_(grid.selection.min), high_(grid.selection.max) {
    const double voxel = std::ldexp(1.0, -grid.fraction());
    bool inside = true;
    for (size_t i = 0; i < 3; ++i) {
      corners_[i] = Point(t.v[i]) * voxel;
      for (int a = 0; a < 3; ++a)
        inside = inside && corners_[i][a] >= low_[a] && corners_[i][a] <= high_[a];
    }
    double longest = -1;
    for (size_t i = 0; i < 3; ++i) {
      const Segment edge{corners_[i], corners_[(i + 1) % 3]};
      const double length = length_of(edge.to - edge.from);
      if (length <= longest) continue;
      longest = length;
      edge_ = edge;
    }
    if (inside) {
      area_ = area_of(corners_[0], corners_[1], corners_[2]);
      return;  // the common case: nothing is cut or copied
    }
    if (!cut_segment(low_, high_, &edge_)) edge_.to = edge_.from;
    cut_ = cut_to_box(Polygon(corners_.begin(), corners_.end()), low_, high_);
    meets_selection_ = !cut_.empty();
    for (size_t i = 2; i < cut_.size(); ++i) area_ += area_of(cut_[0], cut_[i - 1], cut_[i]);
  }

  double weight(Measure measure) const {
    switch (measure) {
      case Measure::kArea:
        return area_;
      case Measure::kLongestEdge:
        return length_of(edge_.to - edge_.from);
      case Measure::kNearTriangle:
        return meets_selection_ ? 1 : 0;
    }
    return 0;
  }

  // Draws a point by the measure and returns its brick.
  uint64_t draw(Measure measure, Random& random) const {
    if (measure == Measure::kLongestEdge)
      return brick(edge_.from + (edge_.to - edge_.from) * random.unit());
    Point point = point_of_polygon(random);
    for (int a = 0; measure == Measure::kNearTriangle && a < 3; ++a)
      point[a] += 2 * random.unit() - 1;
    return brick(point);
  }

 private:
  Point point_of_polygon(Random& random) const {
    const std::span<const Point> polygon = cut_.empty() ? std::span<const Point>(corners_) : cut_;
    double rest = random.unit() * area_, u = random.unit(), v = random.unit();
    size_t i = 2;
    for (; i + 1 < polygon.size(); ++i) {
      rest -= area_of(polygon[0], polygon[i - 1], polygon[i]);
      if (rest < 0) break;
    }
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const size_t last = polygon.size() - 1;  // a cut may leave a segment or a point
    const Point &p = polygon[0], &q = polygon[std::min(i - 1, last)],
                &r = polygon[std::min(i, last)];
    return p + (q - p) * u + (r - p) * v;
  }

  uint64_t brick(const Point& point) const {
    LatticePoint brick;
    for (int a = 0; a < 3; ++a)
      brick[a] = int64_t(std::clamp(std::floor(point[a]), low_[a], high_[a] - 1)) / kBrickSide;
    return cell_code(brick);
  }

  Point low_, high_;
  std::array<Point, 3> corners_;
  Polygon cut_;  // empty if the triangle is entirely inside or entirely outside
  bool meets_selection_ = true;
  Segment edge_{};  // the part of the longest edge inside; a point if none is
  double area_ = 0;
};

// The draws by one measure: ascending positions on the line of all weights laid end to end.
struct MeasureDraws {
  double total = 0, passed = 0;
  std::vector<double> positions;
  size_t next = 0;
};

// Draws a third of the positions by each measure (the first ones get the remainder); a measure
// without weight leaves its share to the next.
void draw_positions(std::array<MeasureDraws, kMeasures>* draws, uint64_t count, Random& random) {
  uint64_t left = 0;
  for (size_t m = 0; m < kMeasures; ++m) {
    MeasureDraws& drawn = (*draws)[m];
    left += (count + kMeasures - 1 - m) / kMeasures;
    if (!(drawn.total > 0)) continue;
    drawn.positions.resize(left);
    left = 0;
    for (double& position : drawn.positions) position = random.unit() * drawn.total;
    std::sort(drawn.positions.begin(), drawn.positions.end());
  }
}

}  // namespace

std::vector<uint64_t> SceneDraw::all() const {
  std::vector<uint64_t> all;
  for (const std::vector<uint64_t>& drawn : codes)
    all.insert(all.end(), drawn.begin(), drawn.end());
  return all;
}

SceneDraw draw_scene(const Scene& scene, const Grid& grid, uint64_t count, Random& random) {
  SceneDraw result;
  if (grid.selection.empty()) return result;
  const LatticeBox selection = grid.closed(grid.selection);
  std::array<MeasureDraws, kMeasures> draws;
  CutScene cuts;  // drawn from whole
  stream_snapped(scene, grid, &cuts,
                 [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
                   cuts.records.clear();
                   for (const LatticeTriangle& t : batch) {
                     if (!selection.meets(box_of(t))) continue;
                     ++result.near;
                     const ClippedTriangle clipped(t, grid);
                     for (size_t m = 0; m < kMeasures; ++m)
                       draws[m].total += clipped.weight(Measure(m));
                   }
                 });
  draw_positions(&draws, count, random);
  stream_snapped(
      scene, grid, &cuts, [&](std::span<const LatticeTriangle> batch, const TriangleBatch&) {
        cuts.records.clear();
        for (const LatticeTriangle& t : batch) {
          if (!selection.meets(box_of(t))) continue;
          const ClippedTriangle clipped(t, grid);
          for (size_t m = 0; m < kMeasures; ++m) {
            MeasureDraws& drawn = draws[m];
            drawn.passed += clipped.weight(Measure(m));
            for (;
                 drawn.next < drawn.positions.size() && drawn.positions[drawn.next] < drawn.passed;
                 ++drawn.next)
              result.codes[m].push_back(clipped.draw(Measure(m), random));
          }
        }
      });
  return result;
}

}  // namespace svdag
