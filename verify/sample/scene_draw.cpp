#include "verify/sample/scene_draw.h"

#include <algorithm>
#include <cmath>

#include "io/brick.h"
#include "verify/judge/cell_code.h"
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

// A triangle's part in the selection, in voxels.
class Part {
 public:
  Part(const LatticeTriangle& t, const Grid& grid)
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
      return;  // nearly always, so nothing is cut or copied for it
    }
    if (!cut_segment(low_, high_, &edge_)) edge_.to = edge_.from;
    cut_ = cut_to_box(Polygon(corners_.begin(), corners_.end()), low_, high_);
    there_ = !cut_.empty();
    for (size_t i = 2; i < cut_.size(); ++i) area_ += area_of(cut_[0], cut_[i - 1], cut_[i]);
  }

  double weight(Measure measure) const {
    switch (measure) {
      case Measure::kArea:
        return area_;
      case Measure::kLongestEdge:
        return length_of(edge_.to - edge_.from);
      case Measure::kTriangle:
        return there_ ? 1 : 0;
    }
    return 0;
  }

  // The brick of a point that the measure draws.
  uint64_t draw(Measure measure, Random& random) const {
    if (measure == Measure::kLongestEdge)
      return brick(edge_.from + (edge_.to - edge_.from) * random.unit());
    Point point = point_of_polygon(random);
    for (int a = 0; measure == Measure::kTriangle && a < 3; ++a) point[a] += 2 * random.unit() - 1;
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
  Polygon cut_;        // empty if the whole triangle is inside, or nothing of it
  bool there_ = true;  // is some of it inside?
  Segment edge_{};     // the part of the longest edge; a point if it has no length
  double area_ = 0;
};

// The draws by one measure: the line of all weights end to end, and ascending places on it.
struct Draws {
  double total = 0, passed = 0;
  std::vector<double> places;
  size_t next = 0;
};

// A third each, one more for the first ones; a measure without weight leaves its share to the next.
void place(std::array<Draws, kMeasures>* draws, uint64_t count, Random& random) {
  uint64_t left = 0;
  for (size_t m = 0; m < kMeasures; ++m) {
    Draws& own = (*draws)[m];
    left += (count + kMeasures - 1 - m) / kMeasures;
    if (!(own.total > 0)) continue;
    own.places.resize(left);
    left = 0;
    for (double& place : own.places) place = random.unit() * own.total;
    std::sort(own.places.begin(), own.places.end());
  }
}

}  // namespace

std::vector<uint64_t> SceneDraw::all() const {
  std::vector<uint64_t> all;
  for (const std::vector<uint64_t>& own : codes) all.insert(all.end(), own.begin(), own.end());
  return all;
}

SceneDraw draw_scene(const Scene& scene, const Grid& grid, uint64_t count, Random& random) {
  SceneDraw result;
  if (grid.selection.empty()) return result;
  const LatticeBox selection = grid.closed(grid.selection);
  std::array<Draws, kMeasures> draws;
  stream_snapped(scene, grid, [&](std::span<const LatticeTriangle> batch) {
    for (const LatticeTriangle& t : batch) {
      if (!selection.meets(box_of(t))) continue;
      ++result.near;
      const Part part(t, grid);
      for (size_t m = 0; m < kMeasures; ++m) draws[m].total += part.weight(Measure(m));
    }
  });
  place(&draws, count, random);
  stream_snapped(scene, grid, [&](std::span<const LatticeTriangle> batch) {
    for (const LatticeTriangle& t : batch) {
      if (!selection.meets(box_of(t))) continue;
      const Part part(t, grid);
      for (size_t m = 0; m < kMeasures; ++m) {
        Draws& own = draws[m];
        own.passed += part.weight(Measure(m));
        for (; own.next < own.places.size() && own.places[own.next] < own.passed; ++own.next)
          result.codes[m].push_back(part.draw(Measure(m), random));
      }
    }
  });
  return result;
}

}  // namespace svdag
