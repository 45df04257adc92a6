// Transforms of glTF nodes, in a fixed order of operations like io/affine.h.
//
//   rotation     of (x, y, z, w) with n = ((x*x + y*y) + z*z) + w*w:
//                diagonal (((w*w + x*x) - y*y) - z*z) / n, cyclic; others (2 * (x*y - w*z)) / n ...
// Dividing by n normalises the quaternion inside the products, so that quarter turns come out as
// exact zeros and ones. Rejected: dividing by sqrt(n) first, which leaves 2e-16 there.
#pragma once

#include <array>

#include "io/affine.h"

namespace svdag {

// Scale, then rotation (a quaternion x, y, z, w of any non-zero length), then translation.
struct Trs {
  std::array<double, 3> translation{0, 0, 0};
  std::array<double, 4> rotation{0, 0, 0, 1};
  std::array<double, 3> scale{1, 1, 1};

  Affine affine() const;
};

}  // namespace svdag
