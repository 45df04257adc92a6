#include "io/scene/polygons/collinear.h"

#include <cmath>
#include <cstddef>

namespace svdag {
namespace {

struct Plane {  // one coordinate plane's part of a point
  double x, y;
};

// Whether the sum of the terms is exactly zero: each is added to an expansion, whose parts do not
// overlap, so that the sum is zero only if every part is.
bool sums_to_zero(const std::array<double, 6>& terms) {
  std::array<double, 6> parts{};
  size_t count = 0;
  for (double carry : terms) {
    for (size_t i = 0; i < count; ++i) {  // two-sum: carry + part = sum + error, exactly
      const double sum = carry + parts[i];
      const double part = sum - carry;
      parts[i] = (carry - (sum - part)) + (parts[i] - part);
      carry = sum;
    }
    parts[count++] = carry;
  }
  for (const double part : parts) {
    if (part != 0) return false;
  }
  return true;
}

bool zero_area(const Plane& a, const Plane& b, const Plane& c) {
  // Both products err by less than 4 units of 2^-53 of themselves, their difference by one more.
  const double left = (b.x - a.x) * (c.y - a.y);
  const double right = (b.y - a.y) * (c.x - a.x);
  if (std::abs(left - right) > 1e-15 * (std::abs(left) + std::abs(right))) return false;
  return sums_to_zero({b.x * c.y, -(b.y * c.x), a.y * c.x, -(a.x * c.y), a.x * b.y, -(a.y * b.x)});
}

}  // namespace

bool collinear(const std::array<float, 3>& a, const std::array<float, 3>& b,
               const std::array<float, 3>& c) {
  for (size_t x = 0; x < 3; ++x) {
    const size_t y = (x + 1) % 3;
    if (!zero_area({a[x], a[y]}, {b[x], b[y]}, {c[x], c[y]})) return false;
  }
  return true;
}

}  // namespace svdag
