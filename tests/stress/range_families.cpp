// Families at the bit limits: |q| up to 2^41 - 1 uses all bits of __int128, beyond it 256 bits.
#include "tests/stress/world.h"

namespace svdag {
namespace {

constexpr int64_t kLimit = (int64_t(1) << 41) - 1;

// Two vertices at opposite ends of the range on every axis, the third so that the triangle passes
// through the region: products in the exact tests come as close to 2^127 as possible.
Soup ends_of_int128(const Spot& spot, StressRandom* random) {
  const LatticePoint at = random->coin() ? spot.corner(random) : spot.anchor(random);
  LatticeTriangle t;
  for (int a = 0; a < 3; ++a) {
    const uint64_t first = random->below(3);
    const int64_t short_of = random->coin() ? 0 : random->log_between(1, kLimit / 4);
    const int64_t low = -kLimit + short_of;
    const int64_t high = kLimit - (random->coin() ? short_of : 0);
    t.v[first][a] = low;
    t.v[(first + 1) % 3][a] = high;
    t.v[(first + 2) % 3][a] = 3 * at[a] - low - high;
  }
  return {t};
}

// One vertex at exactly 2^41 or a step off it: where the narrow path ends.
Soup at_the_switch(const Spot& spot, StressRandom* random) {
  Soup soup = ends_of_int128(spot, random);
  LatticePoint& p = soup[0].v[random->below(3)];
  p[random->axis()] = random->sign() * (kLimit + random->between(0, 2));
  return soup;
}

// Triangles up to 2^61 steps large: 256-bit integers.
Soup beyond_int128(const Spot& spot, StressRandom* random) {
  const int64_t size = random->log_between(kLimit, int64_t(1) << 60);
  const LatticePoint at = random->coin() ? spot.corner(random) : spot.anchor(random);
  if (random->coin())
    return {around_centroid(at, at + random->point(size), at + random->point(size))};
  return {{{at, at + random->point(size), at + random->point(size)}}};
}

// A clip box of 10^-6 of the scene: world coordinates that snap far outside of the grid.
Soup small_clip_box(const Spot& spot, StressRandom* random) {
  const Point at = to_world(spot.grid, anchor_in_voxels(spot, random));
  const double size = 1e6 * double(spot.grid.resolution()) * spot.grid.voxel_size;
  const auto draw = [&] {
    return 0.5 * size * Point(random->unit() - 0.5, random->unit() - 0.5, random->unit() - 0.5);
  };
  const Point a = draw(), b = draw();
  return snapped(spot.grid, {{{at + a, at + b, at - (a + b)}}});
}

}  // namespace

std::vector<Family> range_families() {
  return {{"ends_of_int128", ends_of_int128},
          {"at_the_switch", at_the_switch},
          {"beyond_int128", beyond_int128},
          {"small_clip_box", small_clip_box}};
}

}  // namespace svdag
