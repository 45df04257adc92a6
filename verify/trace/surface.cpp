#include "verify/trace/surface.h"

#include <algorithm>
#include <array>

namespace svdag {
namespace {

constexpr int kRadius = 4;  // voxels; with the bricks around the hit's brick all are seen

using Matrix = std::array<std::array<double, 3>, 3>;

// Sums of 1, p and p p^T over the set voxels within kRadius of the hit, p relative to it.
struct Moments {
  double count = 0;
  Vec3 first{};
  Matrix second{};

  void add(int x, int y, int z) {
    if (x * x + y * y + z * z > kRadius * kRadius) return;
    const double p[3] = {double(x), double(y), double(z)};
    ++count;
    for (int a = 0; a < 3; ++a) {
      first[a] += p[a];
      for (int b = 0; b < 3; ++b) second[a][b] += p[a] * p[b];
    }
  }
};

Moments gather(const DagView& dag, const Hit& hit) {
  Moments moments;
  const int n = int(dag.resolution() / 4);
  const int bx = int(hit.voxel[0] / 4), by = int(hit.voxel[1] / 4), bz = int(hit.voxel[2] / 4);
  for (int x = std::max(bx - 1, 0); x <= std::min(bx + 1, n - 1); ++x) {
    for (int y = std::max(by - 1, 0); y <= std::min(by + 1, n - 1); ++y) {
      for (int z = std::max(bz - 1, 0); z <= std::min(bz + 1, n - 1); ++z) {
        uint64_t brick = dag_brick(dag, uint32_t(x), uint32_t(y), uint32_t(z));
        for (; brick != 0; brick &= brick - 1) {
          const int bit = __builtin_ctzll(brick);
          moments.add(4 * x + (bit >> 4 & 2) + (bit >> 2 & 1) - int(hit.voxel[0]),
                      4 * y + (bit >> 3 & 2) + (bit >> 1 & 1) - int(hit.voxel[1]),
                      4 * z + (bit >> 2 & 2) + (bit & 1) - int(hit.voxel[2]));
        }
      }
    }
  }
  return moments;
}

// Makes m diagonal by Jacobi rotations; the columns of the result are the eigenvectors.
Matrix diagonalize(Matrix* m) {
  Matrix axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  Matrix& s = *m;
  for (int sweep = 0; sweep < 8; ++sweep) {
    for (int p = 0, q = 1; p < 2; q == 2 ? (++p, q = p + 1) : ++q) {
      if (std::abs(s[p][q]) < 1e-12 * (s[p][p] + s[q][q])) continue;
      const double theta = (s[q][q] - s[p][p]) / (2 * s[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), d = t * c;
      for (int k = 0; k < 3; ++k) {
        const double a = s[k][p], b = s[k][q];
        s[k][p] = c * a - d * b;
        s[k][q] = d * a + c * b;
      }
      for (int k = 0; k < 3; ++k) {
        const double a = s[p][k], b = s[q][k];
        s[p][k] = c * a - d * b;
        s[q][k] = d * a + c * b;
        const double x = axes[k][p], y = axes[k][q];
        axes[k][p] = c * x - d * y;
        axes[k][q] = d * x + c * y;
      }
    }
  }
  return axes;
}

}  // namespace

Vec3 surface_normal(const DagView& dag, const Hit& hit, const Vec3& direction) {
  Vec3 normal{};
  normal[hit.axis] = direction[hit.axis] < 0 ? 1 : -1;
  const Moments moments = gather(dag, hit);
  Matrix covariance = moments.second;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b)
      covariance[a][b] -= moments.first[a] * moments.first[b] / moments.count;
  }
  const Matrix axes = diagonalize(&covariance);
  std::array<size_t, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](size_t a, size_t b) { return covariance[a][a] < covariance[b][b]; });
  const size_t least = order[0], middle = order[1];
  // A sheet: thin in one direction, wide in the two others.
  if (!(covariance[least][least] < 0.7 * covariance[middle][middle])) return normal;
  normal = {{axes[0][least], axes[1][least], axes[2][least]}};
  return dot(normal, direction) > 0 ? normal * -1 : normal;
}

}  // namespace svdag
