// Families of triangles on which voxelizers go wrong, for the tests of the judges.
#pragma once

#include <random>

#include "io/triangle.h"

namespace svdag {

constexpr int kShift = 4;  // 16 lattice steps a voxel: planes, edges and corners are hit often
constexpr int64_t kSide = 1 << kShift;
constexpr int kFamilies = 9;

// Coordinates with a bias to what goes wrong: voxel planes, their neighbours, centres.
inline int64_t awkward(std::mt19937_64& random, int64_t reach) {
  const int64_t q = int64_t(random() % uint64_t(2 * reach + 1)) - reach;
  switch (random() % 5) {
    case 0:
      return q >> kShift << kShift;
    case 1:
      return (q >> kShift << kShift) + int64_t(random() % 3) - 1;
    case 2:
      return (q >> kShift << kShift) + kSide / 2;
    default:
      return q;
  }
}

inline LatticePoint awkward_point(std::mt19937_64& random, int64_t reach) {
  return {awkward(random, reach), awkward(random, reach), awkward(random, reach)};
}

// One triangle of a family: 0 general, 1 in a plane of constant coordinate, 2 sliver, 3 segment,
// 4 point, 5 double point, 6 on plane x+y+z = c, 7 all coordinates whole voxels, 8 all coordinates
// voxel centres.
inline LatticeTriangle family_triangle(std::mt19937_64& random, int family, int64_t reach) {
  LatticeTriangle t{
      {awkward_point(random, reach), awkward_point(random, reach), awkward_point(random, reach)}};
  switch (family) {
    case 1:
      for (int a = 0, w = int(random() % 3); a < 3; ++a) t.v[a][w] = t.v[0][w];
      break;
    case 2:
      t.v[2] = t.v[1];
      t.v[2][int(random() % 3)] += int64_t(random() % 3) - 1;
      break;
    case 3: {
      const LatticePoint d = t.v[1] - t.v[0];
      t.v[2] = t.v[0] + d * int64_t(random() % 4);
      break;
    }
    case 4:
      t.v[1] = t.v[2] = t.v[0];
      break;
    case 5: {
      const size_t i = random() % 3;
      t.v[i] = t.v[(i + 1) % 3];
      break;
    }
    case 6:
      for (LatticePoint& p : t.v) p.z = 5 * kSide - p.x - p.y;
      break;
    case 7:
      for (LatticePoint& p : t.v) p = (p / kSide) * kSide;
      break;
    case 8:
      for (LatticePoint& p : t.v) p = (p / kSide) * kSide + kSide / 2;
      break;
    default:
      break;
  }
  return t;
}

// Corners up to 2^40 lattice steps away, or, if `wide`, 2^61: beyond 2^41 products need 256 bits.
inline LatticeTriangle random_giant(std::mt19937_64& random, bool wide) {
  const int64_t reach = int64_t(1) << (wide ? 61 : 40);
  LatticeTriangle t;
  for (LatticePoint& p : t.v) {
    for (int a = 0; a < 3; ++a) p[a] = int64_t(random() % uint64_t(2 * reach)) - reach;
  }
  return t;
}

}  // namespace svdag
