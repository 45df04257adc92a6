// Exact quotients of integers: all the arithmetic of the judge's clipping.
//
// A point where a triangle is cut is a rational number. The judge never compares two of them: of a
// minimum only the voxel at or below it is needed, and ceil and floor are monotone, so
// ceil(min of all) = min of all ceils. One division per point, no tolerance, no common denominator.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag {

__extension__ typedef __int128 Int128;

// Whether every intermediate value about this triangle fits 128 bits (occupancy.h counts them).
inline bool fits_int128(const LatticeTriangle& t) {
  constexpr int64_t kNarrow = int64_t(1) << 41;
  for (const LatticePoint& p : t.v) {
    for (int a = 0; a < 3; ++a) {
      if (p[a] <= -kNarrow || p[a] >= kNarrow) return false;
    }
  }
  return true;
}

// A rational number, seen from the integers: floor == ceil iff it is one.
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
  // base + dividend / divisor, where the result is known to fit 64 bits.
  Rounded plus(int64_t base) const {
    const int64_t floor = base + static_cast<int64_t>(quotient);
    return {floor, floor + (remainder != 0 ? 1 : 0)};
  }
};

}  // namespace svdag
