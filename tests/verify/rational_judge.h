// The reference that judges the judge: one voxel at a time, in rationals, without any shortcut.
//
// The triangle is clipped by the six half-spaces of the closed cube one after the other
// (Sutherland-Hodgman), with cpp_rational coordinates that are allowed to grow; the voxel is
// occupied iff something is left. Slow and obviously right.
#pragma once

#include <boost/multiprecision/cpp_int.hpp>
#include <vector>

#include "io/grid.h"
#include "io/triangle.h"
#include "tests/verify/voxels_where.h"
#include "verify/judge/clip_judge.h"

namespace svdag {

using Rational = boost::multiprecision::cpp_rational;
using RationalPoint = std::array<Rational, 3>;

// The part of a convex polygon (a point, a segment) where sign * (p[axis] - limit) <= 0.
inline std::vector<RationalPoint> clip(const std::vector<RationalPoint>& polygon, int axis,
                                       const Rational& limit, int sign) {
  std::vector<RationalPoint> kept;
  for (size_t i = 0; i < polygon.size(); ++i) {
    const RationalPoint& p = polygon[i];
    const RationalPoint& q = polygon[(i + 1) % polygon.size()];
    const Rational a = sign * (p[axis] - limit), b = sign * (q[axis] - limit);
    if (a <= 0) kept.push_back(p);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
      RationalPoint cut;
      for (int c = 0; c < 3; ++c) cut[c] = p[c] + (q[c] - p[c]) * (a / (a - b));
      kept.push_back(cut);
    }
  }
  return kept;
}

inline bool rational_touches(const LatticeTriangle& t, int shift, const LatticePoint& voxel) {
  std::vector<RationalPoint> polygon;
  for (const LatticePoint& p : t.v)
    polygon.push_back({Rational(p.x), Rational(p.y), Rational(p.z)});
  for (int axis = 0; axis < 3; ++axis) {
    const Rational side = Rational(int64_t(1) << shift);
    polygon = clip(polygon, axis, voxel[axis] * side, -1);
    polygon = clip(polygon, axis, (voxel[axis] + 1) * side, 1);
  }
  return !polygon.empty();
}

// All voxels of `window` that the definition says are occupied.
inline VoxelSet rational_voxels(const LatticeTriangle& t, int shift, const VoxelBox& window) {
  return voxels_where(t, shift, window,
                      [&](const LatticePoint& voxel) { return rational_touches(t, shift, voxel); });
}

// All voxels of `window` that the judge's clipper finds; a voxel found twice fails the caller.
inline VoxelSet clipped_voxels(const LatticeTriangle& t, int shift, const VoxelBox& window,
                               int axis = Clipper::kBestAxis, bool* twice = nullptr) {
  VoxelSet voxels;
  Clipper clipper;
  clipper.run(
      t, shift, window,
      [&](const CellRun& run) {
        LatticePoint p = run.first;
        for (int64_t i = 0; i < run.count; ++i, ++p[run.axis]) {
          const bool added = voxels.emplace(p.x, p.y, p.z).second;
          if (!added && twice != nullptr) *twice = true;
        }
      },
      axis);
  return voxels;
}

}  // namespace svdag
