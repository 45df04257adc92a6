#include "io/scene/gltf/gltf_transform.h"

#include <algorithm>
#include <cmath>

namespace svdag {

double axis_stretch(const Affine& a) {
  double longest = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double square = (a.m[0][c] * a.m[0][c] + a.m[1][c] * a.m[1][c]) + a.m[2][c] * a.m[2][c];
    longest = std::max(longest, square);
  }
  return std::sqrt(longest);
}

Affine compose(const Affine& parent, const Affine& local) {
  Affine result;
  for (int r = 0; r < 3; ++r) {
    const auto& p = parent.m[r];
    for (int c = 0; c < 4; ++c) {
      result.m[r][c] = (p[0] * local.m[0][c] + p[1] * local.m[1][c]) + p[2] * local.m[2][c];
    }
    result.m[r][3] += p[3];
  }
  return result;
}

Affine Trs::affine() const {
  const auto [x, y, z, w] = rotation;
  const double n = ((x * x + y * y) + z * z) + w * w;
  Affine a;
  a.m[0] = {(((w * w + x * x) - y * y) - z * z) / n, (2 * (x * y - w * z)) / n,
            (2 * (x * z + w * y)) / n, 0};
  a.m[1] = {(2 * (x * y + w * z)) / n, (((w * w + y * y) - z * z) - x * x) / n,
            (2 * (y * z - w * x)) / n, 0};
  a.m[2] = {(2 * (x * z - w * y)) / n, (2 * (y * z + w * x)) / n,
            (((w * w + z * z) - x * x) - y * y) / n, 0};
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) a.m[r][c] *= scale[c];
    a.m[r][3] = translation[r];
  }
  return a;
}

}  // namespace svdag
