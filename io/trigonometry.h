// Sine and arc cosine of the first quadrant, of additions, multiplications, divisions and square
// roots in a fixed order: the same bits on every machine and C library.
#pragma once

#include <cmath>

namespace svdag {

// The Taylor polynomials of sine and cosine up to x^23 and x^24, for 0 <= x <= 1.6: the first term
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

// For 0 <= d <= 0.9999, by Newton's method from the first terms of the cosine; four steps suffice.
inline double arc_cosine(double d) {
  double angle = std::sqrt(2 - 2 * d);
  for (int step = 0; step < 5; ++step) angle = angle + (cosine(angle) - d) / sine(angle);
  return angle;
}

}  // namespace svdag
