// Sine, cosine, arc cosine and a root, of additions, multiplications, divisions and square roots in
// a fixed order: the same bits on every machine and C library.
#pragma once

#include <cmath>
#include <cstdint>

namespace svdag {

// The Taylor polynomials of sine and cosine up to x^23 and x^24, for |x| <= 1.6: the first term
// left out is below 2^-60.
inline double sine(double x) {
  double sum = 0;
  for (int k = 22; k > 0; k -= 2) sum = (1 + sum) * -(x * x) / (k * (k + 1));
  return x + x * sum;
}
inline double cosine(double x) {
  double sum = 0;
  for (int k = 23; k > 0; k -= 2) sum = (1 + sum) * -(x * x) / (k * (k + 1));
  return 1 + sum;
}

// The sine of any angle, plus `quarters` quarter turns. Quarter turns of the angle are taken off in
// two parts; the first has 33 bits, so that its multiples are exact (Cody and Waite 1980). Within
// 10^-15 up to 10^6, in [-1, 1] beyond; 0 from 2^32 quarter turns on and for NaN.
inline double sine_of_angle(double angle, int quarters = 0) {
  constexpr double kHigh = 0x1.921fb544p0, kLow = 0x1.0b4611a626331p-34;  // together pi / 2
  const double turns = std::rint(angle / (kHigh + kLow));
  if (!(std::abs(turns) < 0x1p32)) return 0;
  const double rest = (angle - turns * kHigh) - turns * kLow;
  const int quadrant = int((int64_t(turns) + quarters) & 3);
  const double value = quadrant % 2 == 0 ? sine(rest) : cosine(rest);
  return quadrant < 2 ? value : -value;
}
inline double cosine_of_angle(double angle) {
  return sine_of_angle(angle, 1);
}

// For 0 <= d <= 0.9999, by Newton's method from the first terms of the cosine; four steps suffice.
inline double arc_cosine(double d) {
  double angle = std::sqrt(2 - 2 * d);
  for (int step = 0; step < 5; ++step) angle = angle + (cosine(angle) - d) / sine(angle);
  return angle;
}

// For 0.001 <= x <= 1, by Newton's method from 1, which comes down to the root and stays there.
inline double fifth_root(double x) {
  double root = 1;
  for (int step = 0; step < 16; ++step) root = (4 * root + x / ((root * root) * (root * root))) / 5;
  return root;
}

}  // namespace svdag
