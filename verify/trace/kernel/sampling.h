// Directions of the rays of soft shadows and ambient occlusion, the same on every machine.
//
// Random numbers are hashes of (pixel, ray) instead of a generator with a state, so they do not
// depend on the order of threads. n rays are stratified in an s x s grid, s = floor(sqrt(n)); the
// rest are not stratified. The square is mapped to a disk by Shirley and Chiu's concentric map; the
// disk lifted to the hemisphere is cosine-weighted (Malley). Sine and cosine are polynomials,
// because libraries' functions differ in the last bit between host and device.
#pragma once

#include "verify/trace/kernel/vector.h"

namespace svdag {

// A bijective hash of u64 (the finalizer of SplitMix64; Steele et al. 2014).
SVDAG_HD inline uint64_t mix(uint64_t v) {
  v = (v ^ v >> 30) * 0xbf58476d1ce4e5b9U;
  v = (v ^ v >> 27) * 0x94d049bb133111ebU;
  return v ^ v >> 31;
}

struct Point2 {
  double x, y;
};

// Point `index` of `count` in the unit square [0, 1)^2 for pixel `pixel`.
SVDAG_HD inline Point2 square_point(uint64_t pixel, uint32_t index, uint32_t count) {
  const uint64_t bits = mix(mix(pixel + 0x9e3779b97f4a7c15U) ^ index);
  const double x = double(bits >> 32) * 0x1p-32, y = double(bits & 0xffffffffU) * 0x1p-32;
  const uint32_t side = uint32_t(square_root(double(count)));
  if (index >= side * side) return {x, y};
  return {(double(index % side) + x) / side, (double(index / side) + y) / side};
}

// {cosine, sine} of v quarter turns, |v| <= 1/2, with an error below 1e-8.
SVDAG_HD inline Point2 quarter_turns(double v) {
  const double a = v * 1.5707963267948966, s = a * a;
  const double sine = a * (1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72))));
  const double cosine = 1 - s / 2 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90))));
  return {cosine, sine};
}

// Maps the unit square to the unit disk, preserving areas.
SVDAG_HD inline Point2 disk_point(const Point2& square) {
  const double x = 2 * square.x - 1, y = 2 * square.y - 1;
  if (x == 0 && y == 0) return {0, 0};
  const double ax = x < 0 ? -x : x, ay = y < 0 ? -y : y;
  if (ax > ay) {
    const Point2 turn = quarter_turns(y / x / 2);
    return {x * turn.x, x * turn.y};
  }
  const Point2 turn = quarter_turns(x / y / 2);
  return {y * turn.y, y * turn.x};
}

// Completes the unit vector n to an orthonormal basis (Duff et al. 2017).
SVDAG_HD inline void make_basis(const Vec3& n, Vec3* u, Vec3* v) {
  const double sign = n[2] < 0 ? -1 : 1;
  const double a = -1 / (sign + n[2]), b = n[0] * n[1] * a;
  *u = {{1 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]}};
  *v = {{b, sign + n[1] * n[1] * a, -n[1]}};
}

// A unit vector around the unit vector n, with density cosine / pi.
SVDAG_HD inline Vec3 cosine_direction(const Vec3& n, const Point2& square) {
  const Point2 d = disk_point(square);
  const double up = 1 - d.x * d.x - d.y * d.y;
  Vec3 u, v;
  make_basis(n, &u, &v);
  return u * d.x + v * d.y + n * square_root(up > 0 ? up : 0);
}

// The vector from one point to another. If they coincide, a negligible vector instead of zero,
// because rays need a direction.
SVDAG_HD inline Vec3 towards(const Vec3& from, const Vec3& to) {
  const Vec3 difference = to - from;
  return length(difference) > 1e-90 ? difference : Vec3{{1e-90, 0, 0}};
}

// A point of the disk that is the ball's outline as seen from `from`.
SVDAG_HD inline Vec3 light_point(const Vec3& centre, double radius, const Vec3& from,
                                 const Point2& square) {
  const Point2 d = disk_point(square);
  Vec3 u, v;
  make_basis(normalized(towards(from, centre)), &u, &v);
  return centre + u * (d.x * radius) + v * (d.y * radius);
}

}  // namespace svdag
