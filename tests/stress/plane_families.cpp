// Families of ties: geometry exactly on the planes of the grid, and one lattice step off them.
#include "tests/stress/family.h"

namespace svdag {
namespace {

constexpr int64_t kMaxCoordinate = int64_t(1) << 38;

// Rounds down to a whole voxel.
LatticePoint whole(const LatticePoint& p, const Spot& spot) {
  const int f = spot.grid.fraction();
  return {p.x >> f << f, p.y >> f << f, p.z >> f << f};
}

LatticePoint sized_point(const Spot& spot, StressRandom* random) {
  return random->point(random->log_between(spot.voxel(), 64 * spot.voxel()));
}

// Constant on one axis: on a voxel plane plus `offset`.
Soup faces(const Spot& spot, StressRandom* random, int64_t offset) {
  Soup soup(2);
  for (LatticeTriangle& t : soup) {
    const int w = random->axis();
    const LatticePoint corner = spot.corner(random);
    for (LatticePoint& p : t.v) {
      p = spot.anchor(random) + sized_point(spot, random);
      if (random->coin()) p = whole(p, spot);
      p[w] = corner[w] + offset;
    }
  }
  return soup;
}

Soup faces_off_planes(const Spot& spot, StressRandom* random) {
  static constexpr int64_t kOffsets[4] = {-1, 1, 12345, 0};
  const int64_t offset = kOffsets[random->below(4)];
  return faces(spot, random, offset != 0 ? offset : spot.voxel() / 2);
}

// Walls over the whole grid on a plane.
Soup giant_faces(const Spot& spot, StressRandom* random) {
  const int w = random->axis();
  const LatticePoint at = spot.corner(random);
  LatticePoint a = random->point(kMaxCoordinate), b = random->point(kMaxCoordinate);
  if (random->coin()) a = whole(a, spot), b = whole(b, spot);
  a[w] = b[w] = 0;
  return {around_centroid(at, at + a, at + b)};
}

// All vertices on voxel corners.
Soup vertices_on_corners(const Spot& spot, StressRandom* random) {
  Soup soup(2);
  for (LatticeTriangle& t : soup) {
    const LatticePoint at = spot.corner(random);
    const int64_t reach = random->log_between(1, 16);
    for (LatticePoint& p : t.v) p = at + random->point(reach) * spot.voxel();
  }
  return soup;
}

Soup giant_on_corners(const Spot& spot, StressRandom* random) {
  const LatticePoint at = spot.corner(random);
  const LatticePoint a = whole(random->point(kMaxCoordinate), spot);
  const LatticePoint b = whole(random->point(kMaxCoordinate), spot);
  return {around_centroid(at, at + a, at + b)};
}

// All vertices on centres of voxels: every tie of the thin rule.
Soup vertices_on_centres(const Spot& spot, StressRandom* random) {
  Soup soup = vertices_on_corners(spot, random);
  for (LatticeTriangle& t : soup) {
    for (LatticePoint& p : t.v) p += LatticePoint(spot.voxel() / 2);
  }
  return soup;
}

// Vertices on the outer faces of the grid, next to them and beyond.
Soup outer_faces(const Spot& spot, StressRandom* random) {
  const int64_t side = spot.grid.resolution() << spot.grid.fraction();
  Soup soup(3);
  for (LatticeTriangle& t : soup) {
    const LatticePoint at = spot.corner(random);
    for (LatticePoint& p : t.v) {
      p = at + sized_point(spot, random);
      for (int a = 0; a < 3; ++a) {
        const int64_t face = at[a] * 2 < side ? 0 : side;
        if (random->coin()) p[a] = face + (random->coin() ? 0 : random->around(1));
      }
    }
  }
  return soup;
}

// Planes +-x +-y +-z = c through voxel corners, or one step off them.
Soup diagonal_plane(const Spot& spot, StressRandom* random) {
  const LatticePoint at = spot.corner(random);
  const int64_t sign[3] = {random->sign(), random->sign(), random->sign()};
  const int64_t size = random->log_between(8 * spot.voxel(), kMaxCoordinate / 4);
  const bool corners = random->coin();
  const int64_t nudge = random->around(1);
  const auto on_plane = [&] {
    LatticePoint d = random->point(size);
    if (corners) d = whole(d, spot);
    d.z = -sign[2] * (sign[0] * d.x + sign[1] * d.y);
    return d;
  };
  LatticePoint start = at;
  start[random->axis()] += nudge;
  return {around_centroid(start, start + on_plane(), start + on_plane())};
}

// Giants that deviate from a voxel plane by a few lattice steps over their whole length.
Soup near_axis_giant(const Spot& spot, StressRandom* random) {
  const int w = random->axis();
  LatticePoint at = spot.anchor(random);
  at[w] = spot.corner(random)[w];
  LatticePoint a = random->point(kMaxCoordinate), b = random->point(kMaxCoordinate);
  const int64_t lean = random->log_between(1, spot.voxel());
  a[w] = random->around(lean);
  b[w] = random->around(lean);
  return {around_centroid(at, at + a, at + b)};
}

// Triangles of a thousandth of a voxel on planes, edges and corners of voxels.
Soup tiny_on_borders(const Spot& spot, StressRandom* random) {
  Soup soup(16);
  for (LatticeTriangle& t : soup) {
    LatticePoint at = spot.anchor(random);
    const LatticePoint corner = spot.corner(random);
    for (int a = 0; a < 3; ++a) {
      if (random->coin()) at[a] = corner[a];
    }
    for (LatticePoint& p : t.v) p = at + random->point(spot.voxel() / 1000);
    if (random->coin()) t.v[0] = at;
  }
  return soup;
}

}  // namespace

std::vector<Family> plane_families() {
  return {{"faces_on_planes", [](const Spot& s, StressRandom* r) { return faces(s, r, 0); }},
          {"faces_off_planes", faces_off_planes},
          {"giant_faces", giant_faces},
          {"vertices_on_corners", vertices_on_corners},
          {"vertices_on_centres", vertices_on_centres},
          {"giant_on_corners", giant_on_corners},
          {"outer_faces", outer_faces, SpotArea::kBorder},
          {"diagonal_plane", diagonal_plane},
          {"near_axis_giant", near_axis_giant},
          {"tiny_on_borders", tiny_on_borders}};
}

}  // namespace svdag
