#include "builder/farm/planner/colour_survey.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "builder/colours/painted_scene.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// Sums over the triangles of several colours, in voxels; what is outside the grid is left out.
class VaryingTriangles {
 public:
  explicit VaryingTriangles(const Grid& grid)
      : whole_(grid.closed(grid.whole())), voxel_(std::ldexp(1.0, -grid.fraction())) {}

  void add(const PaintedTriangle& t) {
    if (t.has_one_colour()) return;
    const LatticePoint p = t.corners[1].position - t.corners[0].position;
    const LatticePoint q = t.corners[2].position - t.corners[0].position;
    const LatticeBox box = box_of(t.triangle());
    double extent[3], share[3];  // share: of the box, inside
    for (int a = 0; a < 3; ++a) {
      const double whole = double(box.max[a] - box.min[a]);
      const double inside =
          double(std::min(box.max[a], whole_.max[a])) - double(std::max(box.min[a], whole_.min[a]));
      extent[a] = inside * voxel_;
      share[a] = whole > 0 ? inside / whole : 1;
    }
    ++count_;
    for (int a = 0; a < 3; ++a) {
      const int b = (a + 1) % 3, c = (a + 2) % 3;
      const double area = std::abs(double(p[b]) * double(q[c]) - double(p[c]) * double(q[b])) / 2;
      extents_ += extent[a];
      areas_ += area * voxel_ * voxel_ * share[b] * share[c];
    }
  }
  // With cubes of `side` voxels.
  double pairs(double side) const {
    return double(count_) + extents_ / side + areas_ / (side * side);
  }
  // Cubes that are met, if no two triangles are in the same place.
  double cubes(double side) const { return std::min(pairs(side), areas_ / (side * side)); }

 private:
  LatticeBox whole_;
  double voxel_;
  uint64_t count_ = 0;
  double extents_ = 0, areas_ = 0;
};

}  // namespace

ColourWork survey_colours(const Scene& scene, const Grid& grid, const ColourPassConfig& pass,
                          Workspace* workspace, SceneCounts* counts) {
  VaryingTriangles varying(grid);
  PaintedScene painted;
  ColourWork work;
  painted.visit = [&](const PaintedTriangle& t) {
    varying.add(t);
    ++work.triangles;
  };
  SceneReader reader(grid, 0, 0, 0, workspace, &painted);
  workspace->budget()->lap_peak();
  *counts = scene.stream([&](const TriangleBatch& batch) {
    check_interrupt();
    reader.read(batch);
  });
  work.read_bytes = workspace->budget()->lap_peak();
  work.level = pass.level.value_or(level_for(painted.density, grid.levels));
  const double side = double(uint64_t(1) << (grid.levels - work.level));
  work.pairs = varying.pairs(side);
  work.cubes = varying.cubes(side);
  std::set<const LinearImage*> images;
  for (const Paint& paint : painted.paints) {
    if (paint.image && images.insert(paint.image.get()).second)
      work.texels += uint64_t(paint.image->width() * paint.image->height());
  }
  return work;
}

}  // namespace svdag
