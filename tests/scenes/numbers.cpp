#include "tests/scenes/numbers.h"

#include <cmath>

namespace svdag::scenes {
namespace {

// Taylor polynomials on [-pi/4, pi/4]; the first term left out is below 2^-50.
double sin_series(double x) {
  const double s = x * x;
  return x * (1 + s * (-1 / 6.0 +
                       s * (1 / 120.0 + s * (-1 / 5040.0 + s * (1 / 362880.0 - s / 39916800.0)))));
}

double cos_series(double x) {
  const double s = x * x;
  return 1 + s * (-1 / 2.0 +
                  s * (1 / 24.0 + s * (-1 / 720.0 +
                                       s * (1 / 40320.0 - s * (1 / 3628800.0 - s / 479001600.0)))));
}

double blend(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

double mix(double a, double b, double t) {
  return a + (b - a) * t;
}

double lattice_value(uint64_t seed, int64_t x, int64_t y, int64_t z) {
  const uint64_t key = hash(hash(hash(seed, uint64_t(x)), uint64_t(y)), uint64_t(z));
  return double(key >> 11) * 0x1p-52 - 1;
}

}  // namespace

double sin_turns(double turns) {
  constexpr double kTwoPi = 6.283185307179586;
  turns -= std::floor(turns);
  const int quarter = int(turns * 4 + 0.5);
  const double x = (turns - quarter * 0.25) * kTwoPi;
  switch (quarter & 3) {
    case 0:
      return sin_series(x);
    case 1:
      return cos_series(x);
    case 2:
      return -sin_series(x);
    default:
      return -cos_series(x);
  }
}

double cos_turns(double turns) {
  return sin_turns(turns - std::floor(turns) + 0.25);
}

uint64_t hash(uint64_t seed, uint64_t i) {
  uint64_t x = seed + (i + 1) * 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31);
}

double uniform(uint64_t seed, uint64_t i) {
  return double(hash(seed, i) >> 11) * 0x1p-53;
}

double length(const Point& p) {
  return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

Point normalised(const Point& p) {
  const double l = length(p);
  return {p.x / l, p.y / l, p.z / l};
}

double noise(uint64_t seed, const Point& p) {
  const double fx = std::floor(p.x), fy = std::floor(p.y), fz = std::floor(p.z);
  const int64_t x = int64_t(fx), y = int64_t(fy), z = int64_t(fz);
  const double tx = blend(p.x - fx), ty = blend(p.y - fy), tz = blend(p.z - fz);
  const auto along_x = [&](int64_t dy, int64_t dz) {
    return mix(lattice_value(seed, x, y + dy, z + dz), lattice_value(seed, x + 1, y + dy, z + dz),
               tx);
  };
  return mix(mix(along_x(0, 0), along_x(1, 0), ty), mix(along_x(0, 1), along_x(1, 1), ty), tz);
}

double fractal(uint64_t seed, Point p, int octaves) {
  double sum = 0, amplitude = 1;
  for (int octave = 0; octave < octaves; ++octave) {
    sum += amplitude * noise(hash(seed, uint64_t(octave)), p);
    for (int a = 0; a < 3; ++a) p[a] = p[a] * 2;
    amplitude *= 0.5;
  }
  return sum;
}

double quantised(double x) {
  return std::nearbyint(x * 0x1p16) * 0x1p-16;
}

Point quantised(const Point& p) {
  return {quantised(p.x), quantised(p.y), quantised(p.z)};
}

}  // namespace svdag::scenes
