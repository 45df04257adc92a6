// Whether a triangle of floats has exactly no area.
//
// After Shewchuk, "Adaptive Precision Floating-Point Arithmetic" (1997): a filter in double, then
// an exact sum. Each component of (b - a) x (c - a), expanded, is a sum of six products of floats;
// a product of two floats is exact in double (48 bits, between 2^-298 and 2^256), so the sum is
// exact once its rounding errors are kept (two-sum). No input is out of range.
#pragma once

#include <array>

namespace svdag {

bool collinear(const std::array<float, 3>& a, const std::array<float, 3>& b,
               const std::array<float, 3>& c);

}  // namespace svdag
