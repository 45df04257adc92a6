// Families of rays that are hard for a traversal: each hits planes, edges and corners differently.
#pragma once

#include <cstdlib>
#include <random>

#include "tests/verify/raw_dag.h"
#include "verify/trace/kernel/ray.h"

namespace svdag {

constexpr int kRayFamilies = 10;

// SVDAG_LONG=1: a hundred times as many rays.
inline int rays_per_family() {
  return std::getenv("SVDAG_LONG") != nullptr ? 400000 : 4000;
}

class RayFamilies {
 public:
  RayFamilies(uint64_t seed, double n) : random_(seed), n_(n) {}

  double unit() { return double(random_() >> 11) * 0x1p-53; }
  double corner() { return std::floor(unit() * n_); }

  // `near`: a point near occupied voxels.
  Ray ray(int family, const Vec3& near) {
    Ray ray;
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = (3 * unit() - 1) * n_;
      ray.direction[a] = near[a] + 8 * unit() - 4 - ray.origin[a];  // towards `near`
    }
    const int axis = int(random_() % 3);
    switch (family) {
      case 0:
        break;
      case 1:
        return along_axis(axis, near, 0.5);
      case 2:
        return along_axis(axis, near, 0);  // in a plane between voxels, or along an edge
      case 3:                              // starts inside
        for (int a = 0; a < 3; ++a) ray.origin[a] = near[a] + 16 * unit() - 8;
        break;
      case 4:  // from corner to corner: every crossing is a tie
        for (int a = 0; a < 3; ++a) {
          ray.origin[a] = corner();
          ray.direction[a] = std::floor(near[a]) - ray.origin[a];
        }
        break;
      case 5:  // diagonals, through corners and edges
        for (int a = 0; a < 3; ++a) {
          ray.direction[a] = double(int(random_() % 3)) - 1;
          ray.origin[a] = std::floor(near[a]) - 37 * ray.direction[a];
        }
        break;
      case 6:  // almost along an axis
        ray = along_axis(axis, near, 0.5);
        for (int a = 0; a < 3; ++a)
          ray.direction[a] += (unit() - 0.5) * std::ldexp(1, -int(random_() % 70));
        break;
      case 7:  // small slopes in a plane between voxels
        ray = along_axis(axis, near, 0);
        ray.direction[(axis + 1) % 3] = (unit() - 0.5) * 0x1p-18;
        break;
      case 8:  // from far away
        for (int a = 0; a < 3; ++a) ray.origin[a] *= std::ldexp(1, int(random_() % 24));
        for (int a = 0; a < 3; ++a) ray.direction[a] = near[a] - ray.origin[a];
        break;
      default:  // odd lengths of the direction
        const double size = std::ldexp(1 + unit(), int(random_() % 120) - 60);
        for (int a = 0; a < 3; ++a) ray.direction[a] *= size;
    }
    bool is_zero = true;
    for (int a = 0; a < 3; ++a) is_zero = is_zero && ray.direction[a] == 0;
    if (is_zero) ray.direction[axis] = 1;
    return ray;
  }

  Span span() {
    const uint64_t kind = random_() % 4;
    if (kind == 0) return {unit(), 0.5 + unit()};
    return kind == 1 ? Span{0, unit()} : Span{};
  }
  // Usually no cut.
  Cut cut(uint32_t levels) {
    Cut cut;
    const uint64_t kind = random_() % 8;
    if (kind == 0) cut.level = uint32_t(random_() % (levels + 2));
    if (kind <= 1) cut.spread = std::ldexp(unit(), -int(random_() % 12));
    return cut;
  }

 private:
  Ray along_axis(int axis, const Vec3& near, double offset) {
    Ray ray;
    for (int a = 0; a < 3; ++a) {
      ray.origin[a] = std::floor(near[a]) + offset;
      ray.direction[a] = 0;
    }
    const bool backward = random_() % 2;
    ray.origin[axis] = backward ? n_ + 3 : -3;
    ray.direction[axis] = backward ? -1 : 1;
    return ray;
  }

  std::mt19937_64 random_;
  double n_;
};

// Clusters of voxels, in corners and in the middle, so that coarse and fine empty cubes alternate.
inline VoxelSet clustered_voxels(int levels, uint64_t seed, int clusters) {
  std::mt19937_64 random(seed);
  const int64_t n = int64_t(1) << levels;
  VoxelSet voxels;
  for (int c = 0; c < clusters; ++c) {
    int64_t at[3];
    for (int64_t& v : at) v = int64_t(random() % uint64_t(n));
    if (c == 0) at[0] = at[1] = at[2] = 0;
    if (c == 1) at[0] = at[1] = at[2] = n - 1;
    const int64_t reach = int64_t(1) << random() % 4;
    for (int i = 0; i < 40; ++i) {
      int64_t v[3];
      for (int a = 0; a < 3; ++a)
        v[a] = std::clamp(at[a] + int64_t(random() % uint64_t(2 * reach + 1)) - reach, int64_t(0),
                          n - 1);
      voxels.emplace(v[0], v[1], v[2]);
    }
  }
  return voxels;
}

}  // namespace svdag
