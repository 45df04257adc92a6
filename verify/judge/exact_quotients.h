// Exact quotients of integers: the arithmetic of the judge's clipping.
//
// The coordinates of a cut are rational numbers. The judge never compares two of them: it only
// needs the voxel at or below a minimum, and ceil and floor are monotone, so ceil(min of all) = min
// of all ceils. One division per point, no tolerance, no common denominator.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag {

__extension__ typedef __int128 Int128;

// True if 128 bits hold every intermediate value for this triangle (see clip_judge.h).
inline bool fits_int128(const LatticeTriangle& t) {
  constexpr int64_t kNarrow = int64_t(1) << 41;
  for (const LatticePoint& p : t.v) {
    for (int a = 0; a < 3; ++a) {
      if (p[a] <= -kNarrow || p[a] >= kNarrow) return false;
    }
  }
  return true;
}

// A rational number rounded down and up; floor == ceil iff it is an integer.
struct Rounded {
  int64_t floor;
  int64_t ceil;
};

// quotient * divisor + remainder == dividend and 0 <= remainder < divisor, for divisor > 0.
template <class Int>
struct Division {
  Int quotient;
  Int remainder;

  Division(const Int& dividend, const Int& divisor)
      : quotient(dividend / divisor), remainder(dividend - quotient * divisor) {
    if (remainder < 0) {
      quotient -= 1;
      remainder += divisor;
    }
  }
  // base + dividend / divisor; the result must fit 64 bits.
  Rounded plus(int64_t base) const {
    const int64_t floor = base + static_cast<int64_t>(quotient);
    return {floor, floor + (remainder != 0 ? 1 : 0)};
  }
};

}  // namespace svdag
