// Families of coordinates: scenes far from zero, in any unit, at the ends of the range of double.
#include <cmath>

#include "io/float_rounding.h"
#include "tests/stress/world.h"

namespace svdag {
namespace {

// A lattice grid whose corner is at most 1024 voxels below `corner` (world) on each axis.
Grid lattice_grid(int levels, double size, const Point& corner) {
  Grid grid = unit_grid(levels);
  grid.kind = Grid::Kind::kLattice;
  grid.voxel_size = size;
  for (int a = 0; a < 3; ++a) grid.k0[a] = int64_t(std::floor(corner[a] / size / 1024)) * 1024;
  return grid;
}

Grid box_grid(int levels, double size, const Point& corner) {
  Grid grid = unit_grid(levels);
  grid.voxel_size = size;
  grid.origin = corner;
  return grid;
}

// Triangles of a few voxels in world doubles; `adjust` changes each coordinate.
template <class Adjust>
Soup world_soup(const Spot& spot, StressRandom* random, const Adjust& adjust) {
  std::vector<Triangle> triangles(4);
  for (Triangle& t : triangles) {
    const Point at = anchor_in_voxels(spot, random);
    const double size = double(random->log_between(1, 32));
    for (Point& p : t.v) {
      const Point d(random->unit() - 0.5, random->unit() - 0.5, random->unit() - 0.5);
      p = to_world(spot.grid, at + size * d);
      for (int a = 0; a < 3; ++a) p[a] = adjust(p[a]);
    }
  }
  return snapped(spot.grid, triangles);
}

// Coordinates as in a national survey grid: metres with centimetres.
Grid utm_grid(int levels, StressRandom* random) {
  static constexpr double kSizes[4] = {0.01, 0.1, 0.25, 1.0};
  const double size = kSizes[random->below(4)];
  const Point corner(5e5 + 1e3 * random->unit(), 4e6 + 1e3 * random->unit(), 100);
  return random->coin() ? lattice_grid(levels, size, corner) : box_grid(levels, size, corner);
}

Soup utm_centimetres(const Spot& spot, StressRandom* random) {
  return world_soup(spot, random, [](double x) { return std::nearbyint(x * 100) / 100; });
}

Soup utm_floats(const Spot& spot, StressRandom* random) {
  return world_soup(spot, random, [](double x) { return round_to_float(x); });
}

// Voxel sizes that are not exact in double, and vertices at multiples of half of them: on planes
// except for the rounding of the world coordinates.
Grid non_dyadic_grid(int levels, StressRandom* random) {
  static constexpr double kSizes[5] = {0.1, 0.3, 0.7, 1.0 / 3, 0.001};
  const Point corner(random->unit(), -1e3 * random->unit(), 1e4 * random->unit());
  return lattice_grid(levels, kSizes[random->below(5)], corner);
}

Soup non_dyadic(const Spot& spot, StressRandom* random) {
  const double half = spot.grid.voxel_size / 2;
  return world_soup(spot, random, [=](double x) { return std::nearbyint(x / half) * half; });
}

// The same scene in a unit so small, or so large, that float arithmetic over- or underflows.
Family scaled(const char* name, double unit) {
  return {name,
          [unit](const Spot& spot, StressRandom* random) {
            const bool on_planes = random->coin();
            return world_soup(spot, random, [=](double x) {
              return on_planes ? std::nearbyint(x / unit * 2) / 2 * unit : x;
            });
          },
          SpotArea::kAnywhere,
          [unit](int levels, StressRandom* random) {
            const double size = (random->coin() ? 1 : 0.37) * unit;
            const Point corner = unit * 1e3 * Point(random->unit(), random->unit(), random->unit());
            return random->coin() ? lattice_grid(levels, size, corner)
                                  : box_grid(levels, size, corner);
          }};
}

// A grid with zero in its middle. (k0 is the plane of voxel -N/2, for N = 1K not a multiple of
// 1024; the snap does not require one.)
Grid around_zero(int levels, double size) {
  Grid grid = lattice_grid(levels, size, Point(0));
  for (int a = 0; a < 3; ++a) grid.k0[a] = -grid.resolution() / 2;
  return grid;
}

// Coordinates that are zero of either sign, denormal, or ordinary.
Soup denormals(const Spot& spot, StressRandom* random) {
  constexpr double kDenormal = 0x1p-1074;
  return world_soup(spot, random, [&](double x) {
    const double denormal = std::copysign(kDenormal * double(random->log_between(1, 1LL << 51)), x);
    const double values[6] = {0.0, -0.0, denormal, -denormal, x, x};
    return values[random->below(6)];
  });
}

// A whole scene of denormals: 1024 voxels and less are below 2^-1022.
Soup denormal_scene(const Spot& spot, StressRandom* random) {
  return world_soup(spot, random, [&](double x) { return random->below(8) == 0 ? -0.0 : x; });
}

}  // namespace

std::vector<Family> coordinate_families() {
  const auto zero_grid = [](int levels, StressRandom*) { return around_zero(levels, 1); };
  const auto smallest_grid = [](int levels, StressRandom*) {
    return around_zero(levels, 0x1p-1021);
  };
  return {{"utm_centimetres", utm_centimetres, SpotArea::kAnywhere, utm_grid},
          {"utm_floats", utm_floats, SpotArea::kAnywhere, utm_grid},
          {"non_dyadic_voxels", non_dyadic, SpotArea::kAnywhere, non_dyadic_grid},
          scaled("scaled_2^-110", 0x1p-110),
          scaled("scaled_2^50", 0x1p50),
          {"denormals_and_zeros", denormals, SpotArea::kMiddle, zero_grid},
          {"denormal_scene", denormal_scene, SpotArea::kMiddle, smallest_grid}};
}

}  // namespace svdag
