// Rounds a double to the nearest float.
//
// g++ 12 at -O2 and -O3 turns two neighbouring double -> float -> double conversions into a plain
// copy (its SLP vectorizer folds the pair), so a plain double(float(x)) does not round. The
// volatile store keeps the conversion; tests/io/float_rounding_test.cpp fails if it is lost.
#pragma once

namespace svdag {

inline double round_to_float(double value) noexcept {
  volatile float rounded = float(value);
  return double(rounded);
}

}  // namespace svdag
