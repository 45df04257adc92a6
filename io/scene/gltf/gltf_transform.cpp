#include "io/scene/gltf/gltf_transform.h"

namespace svdag {

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
