#include "verify/trace/surface.h"

#include <algorithm>
#include <array>

namespace svdag {
namespace {

constexpr int kRadius = 4;  // voxels; with the bricks around the hit's brick all are seen

using Matrix = std::array<std::array<double, 3>, 3>;

// Sums of 1, p and p p^T over the set voxels within kRadius of the hit, p relative to it.
struct Moments {
  int count = 0;
  int first[3] = {};
  int second[6] = {};  // xx, yy, zz, xy, yz, zx

  void add(int x, int y, int z) {
    if (x * x + y * y + z * z > kRadius * kRadius) return;
    ++count;
    const int p[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      first[a] += p[a];
      second[a] += p[a] * p[a];
      second[3 + a] += p[a] * p[(a + 1) % 3];
    }
  }
  Matrix covariance() const {
    Matrix m;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const int sum = a == b ? second[a] : second[3 + (b == (a + 1) % 3 ? a : b)];
        m[size_t(a)][size_t(b)] = sum - double(first[a]) * first[b] / count;
      }
    }
    return m;
  }
};

// Collects the moments in one descent that leaves out everything beyond the bricks next to the
// hit's; the way down is shared by all of them.
class Gather {
 public:
  Gather(const DagView& dag, const Hit& hit) : dag_(dag) {
    for (int a = 0; a < 3; ++a) {
      voxel_[a] = int(hit.voxel[a]);
      low_[a] = voxel_[a] / 4 - 1;
      high_[a] = voxel_[a] / 4 + 1;
    }
  }

  // The node covers 2^(brick level - level) bricks a side from brick (x, y, z) on.
  void visit(uint32_t level, uint32_t node, int x, int y, int z) {
    if (level == dag_.brick_level()) return add_brick(dag_.bricks[node], 4 * x, 4 * y, 4 * z);
    const int half = 1 << (dag_.brick_level() - level - 1);
    for (unsigned c = 0; c < 8; ++c) {
      const int cx = x + (c & 4 ? half : 0), cy = y + (c & 2 ? half : 0),
                cz = z + (c & 1 ? half : 0);
      if (!near(cx, half, 0) || !near(cy, half, 1) || !near(cz, half, 2)) continue;
      const uint32_t child = dag_child(dag_, level, node, c);
      if (child != kNoChild) visit(level + 1, child, cx, cy, cz);
    }
  }
  const Moments& moments() const { return moments_; }

 private:
  bool near(int from, int size, int axis) const {
    return from <= high_[axis] && from + size > low_[axis];
  }
  void add_brick(uint64_t brick, int x, int y, int z) {
    for (; brick != 0; brick &= brick - 1) {
      const int bit = __builtin_ctzll(brick);
      moments_.add(x + (bit >> 4 & 2) + (bit >> 2 & 1) - voxel_[0],
                   y + (bit >> 3 & 2) + (bit >> 1 & 1) - voxel_[1],
                   z + (bit >> 2 & 2) + (bit & 1) - voxel_[2]);
    }
  }

  const DagView& dag_;
  int voxel_[3], low_[3], high_[3];
  Moments moments_;
};

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
  Gather gather(dag, hit);
  gather.visit(0, 0, 0, 0, 0);
  Matrix covariance = gather.moments().covariance();
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
