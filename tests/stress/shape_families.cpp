// Families of triangle shapes, at any position.
#include <cmath>

#include "io/float_rounding.h"
#include "io/lattice.h"
#include "tests/stress/family.h"

namespace svdag {
namespace {

constexpr int64_t kMaxCoordinate = int64_t(1) << 38;  // half size of giants: |q| stays below 2^41

Soup eight_voxels(const Spot& spot, StressRandom* random) {
  Soup soup(6);
  for (LatticeTriangle& t : soup) {
    const LatticePoint at = spot.anchor(random);
    for (LatticePoint& p : t.v) p = at + random->point(4 * spot.voxel());
  }
  return soup;
}

// Triangles of 16 voxels to many times the grid that pass through the region.
Soup giant(const Spot& spot, StressRandom* random) {
  const int64_t size = random->log_between(16 * spot.voxel(), kMaxCoordinate);
  const LatticePoint at = spot.anchor(random);
  return {around_centroid(at, at + random->point(size), at + random->point(size))};
}

// The same, with an edge or a vertex in the region instead of the middle.
Soup giant_border(const Spot& spot, StressRandom* random) {
  const int64_t size = random->log_between(16 * spot.voxel(), kMaxCoordinate);
  const LatticePoint at = spot.anchor(random), d = random->point(size);
  const LatticePoint third = at + random->point(size);
  if (random->coin()) return {{{at, at + d, third}}};
  return {{{at + d, at - d + random->point(3), third}}};
}

// A sliver with a given aspect ratio, of double (or float) world coordinates, then snapped.
Family sliver(const char* name, double aspect, bool floats) {
  return {name, [=](const Spot& spot, StressRandom* random) {
            const Lattice lattice(spot.grid);
            const double scale = double(spot.voxel());
            const Point at = Point(spot.anchor(random)) / scale;
            const double half = double(random->log_between(16, spot.grid.resolution()));
            const Point d =
                half * Point(random->unit() - 0.5, random->unit() - 0.5, random->unit() - 0.5);
            const Point height =
                2 * half / aspect *
                Point(random->unit() - 0.5, random->unit() - 0.5, random->unit() - 0.5);
            const double middle = random->unit() - 0.5;
            const Point corners[3] = {at - d, at + d, at + middle * d + height};
            LatticeTriangle t;
            for (int i = 0; i < 3; ++i) {
              Point p = corners[i];
              for (int a = 0; a < 3 && floats; ++a) p[a] = round_to_float(p[a]);
              t.v[i] = lattice.snap(p);
            }
            return Soup{t};
          }};
}

// Exactly collinear: multiples of one vector, the third vertex between the other two or not.
Soup collinear(const Spot& spot, StressRandom* random) {
  Soup soup(3);
  for (LatticeTriangle& t : soup) {
    const LatticePoint at = spot.anchor(random);
    LatticePoint d = random->point(random->log_between(1, kMaxCoordinate / 16));
    if (random->coin()) d[random->axis()] = 0;
    for (LatticePoint& p : t.v) p = at + d * random->around(8);
  }
  return soup;
}

// Along axes and diagonals through voxel corners: every touched voxel is a tie.
Soup collinear_on_corners(const Spot& spot, StressRandom* random) {
  Soup soup(2);
  for (LatticeTriangle& t : soup) {
    const LatticePoint at = spot.corner(random);
    const LatticePoint d = random->point(1) * spot.voxel();
    for (LatticePoint& p : t.v) p = at + d * random->around(20);
  }
  return soup;
}

// The same triangles several times, turned and mirrored.
Soup duplicates(const Spot& spot, StressRandom* random) {
  Soup soup;
  for (int i = 0; i < 3; ++i) {
    const LatticePoint at = spot.anchor(random);
    const LatticePoint p[3] = {at, at + random->point(6 * spot.voxel()),
                               at + random->point(6 * spot.voxel())};
    soup.push_back({{p[0], p[1], p[2]}});
    soup.push_back({{p[1], p[2], p[0]}});
    soup.push_back({{p[1], p[0], p[2]}});
  }
  return soup;
}

// Two equal vertices, or three: segments and points, many of them on planes, edges and corners.
Soup points_and_segments(const Spot& spot, StressRandom* random) {
  Soup soup(12);
  for (LatticeTriangle& t : soup) {
    LatticePoint at = spot.anchor(random);
    const LatticePoint corner = spot.corner(random);
    for (int a = 0; a < 3; ++a) {
      if (random->coin()) at[a] = corner[a] + random->around(1);
      if (random->coin()) at[a] = corner[a];
    }
    const bool point = random->coin();
    const LatticePoint end = point ? at : at + random->point(5 * spot.voxel());
    t = {{at, end, random->coin() ? at : end}};
  }
  return soup;
}

}  // namespace

std::vector<Family> shape_families() {
  return {{"eight_voxels", eight_voxels},
          {"giant", giant},
          {"giant_border", giant_border},
          sliver("sliver_1e6_double", 1e6, false),
          sliver("sliver_1e6_float", 1e6, true),
          sliver("sliver_1e12_double", 1e12, false),
          sliver("sliver_1e12_float", 1e12, true),
          {"collinear", collinear},
          {"collinear_on_corners", collinear_on_corners},
          {"duplicates", duplicates},
          {"points_and_segments", points_and_segments}};
}

}  // namespace svdag
