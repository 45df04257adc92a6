// Estimates the normal of a surface from its voxels, for host and CUDA.
//
// Idea: Hoppe et al. 1992. The set voxels near a hit are samples of the surface; the direction of
// their smallest covariance is its normal. Where the voxels do not form a sheet (a wire, a single
// voxel), the normal is of the face that the ray entered.
// Rejected: weights that fall towards the rim of the neighbourhood. On a smooth shape, the rings where
// its voxels are wide terraces stay.
#pragma once

#include "verify/trace/kernel/vector.h"

namespace svdag {

constexpr int kNormalRadius = 4;  // voxels: reaches only into the 26 bricks around the hit's

// Sums of 1, p and p p^T over the set voxels within kNormalRadius of the hit, p relative to it.
struct Moments {
  int count = 0;
  int first[3] = {};
  int second[6] = {};  // xx, yy, zz, xy, yz, zx

  SVDAG_HD void add(int x, int y, int z) {
    if (x * x + y * y + z * z > kNormalRadius * kNormalRadius) return;
    ++count;
    const int p[3] = {x, y, z};
    for (int a = 0; a < 3; ++a) {
      first[a] += p[a];
      second[a] += p[a] * p[a];
      second[3 + a] += p[a] * p[(a + 1) % 3];
    }
  }
  SVDAG_HD double covariance(int a, int b) const {
    const int sum = a == b ? second[a] : second[3 + (b == (a + 1) % 3 ? a : b)];
    return sum - double(first[a]) * first[b] / count;
  }
};

// Looks up bricks, each from its common ancestor with the previous one.
class BrickPath {
 public:
  SVDAG_HD explicit BrickPath(const DagView& dag) : dag_(dag) {}
  explicit BrickPath(DagView&&) = delete;

  // Same result as dag_brick().
  SVDAG_HD uint64_t brick(uint32_t x, uint32_t y, uint32_t z) {
    const uint32_t bricks = dag_.brick_level();
    uint32_t level = 0;  // of the deepest valid node that both paths share
    while (level < valid_level_ && !(((x ^ x_) | (y ^ y_) | (z ^ z_)) >> (bricks - 1 - level)))
      ++level;
    x_ = x, y_ = y, z_ = z;
    for (; level < bricks; ++level) {
      const unsigned c = octant_of(x, y, z, bricks - 1 - level);
      nodes_[level + 1] = dag_child(dag_, level, nodes_[level], c);
      if (nodes_[level + 1] == kNoChild) break;
    }
    valid_level_ = level;
    return level == bricks ? dag_.bricks[nodes_[bricks]] : 0;
  }

 private:
  const DagView& dag_;
  uint32_t x_ = 0, y_ = 0, z_ = 0;
  uint32_t valid_level_ = 0;  // nodes_[0 .. valid_level_] are the path to brick (x_, y_, z_)
  uint32_t nodes_[kMaxSections] = {};
};

// Coordinate `axis`, 0 .. 3, of the voxel in bit `bit` of a brick.
SVDAG_HD inline int brick_coordinate(int bit, int axis) {
  return (bit >> (4 - axis) & 2) + (bit >> (2 - axis) & 1);
}

// Whether a voxel of the cube with this corner, relative to the hit, and side is within
// kNormalRadius.
SVDAG_HD inline bool is_near(const int corner[3], int side) {
  int square = 0;
  for (int a = 0; a < 3; ++a) {
    const int low = corner[a], high = corner[a] + side - 1;
    const int nearest = low > 0 ? low : high < 0 ? high : 0;
    square += nearest * nearest;
  }
  return square <= kNormalRadius * kNormalRadius;
}

// Adds the voxels of the brick with this corner, relative to the hit: of the eight cubes of 2^3
// voxels, those that are near.
SVDAG_HD inline void add_brick(uint64_t brick, const int corner[3], Moments* moments) {
  for (int first = 0; brick != 0; first += 8, brick >>= 8) {
    const int cube[3] = {corner[0] + brick_coordinate(first, 0),
                         corner[1] + brick_coordinate(first, 1),
                         corner[2] + brick_coordinate(first, 2)};
    if ((brick & 0xffU) == 0 || !is_near(cube, 2)) continue;
    for (int bit = 0; bit < 8; ++bit) {
      if (brick >> bit & 1U)
        moments->add(cube[0] + (bit >> 2), cube[1] + (bit >> 1 & 1), cube[2] + (bit & 1));
    }
  }
}

SVDAG_HD inline Moments moments_around(const DagView& dag, const uint32_t voxel[3]) {
  Moments moments;
  BrickPath path(dag);
  const uint32_t bricks = dag.resolution() / 4;
  for (int i = 0; i < 27; ++i) {
    uint32_t at[3];
    int corner[3];
    const int step[3] = {i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1};
    bool inside = true;
    for (int a = 0; a < 3; ++a) {
      at[a] = voxel[a] / 4 + uint32_t(step[a]);  // below 0 it wraps, and is outside
      corner[a] = int(4 * at[a]) - int(voxel[a]);
      inside = inside && at[a] < bricks;
    }
    if (inside && is_near(corner, 4)) add_brick(path.brick(at[0], at[1], at[2]), corner, &moments);
  }
  return moments;
}

// Makes m diagonal by Jacobi rotations; the columns of `axes` are the eigenvectors.
SVDAG_HD inline void diagonalize(double m[3][3], double axes[3][3]) {
  for (int i = 0; i < 9; ++i) axes[i / 3][i % 3] = i % 4 == 0;
  for (int turn = 0; turn < 24; ++turn) {
    const int p = turn % 3 == 2 ? 1 : 0, q = turn % 3 == 0 ? 1 : 2;
    const double off = m[p][q], size = off < 0 ? -off : off;
    if (size < 1e-12 * (m[p][p] + m[q][q])) continue;
    const double theta = (m[q][q] - m[p][p]) / (2 * off), width = theta < 0 ? -theta : theta;
    const double t = (theta < 0 ? -1 : 1) / (width + square_root(theta * theta + 1));
    const double c = 1 / square_root(t * t + 1), d = t * c;
    for (int k = 0; k < 3; ++k) {
      const double a = m[k][p], b = m[k][q];
      m[k][p] = c * a - d * b;
      m[k][q] = d * a + c * b;
    }
    for (int k = 0; k < 3; ++k) {
      const double a = m[p][k], b = m[q][k], x = axes[k][p], y = axes[k][q];
      m[p][k] = c * a - d * b;
      m[q][k] = d * a + c * b;
      axes[k][p] = c * x - d * y;
      axes[k][q] = d * x + c * y;
    }
  }
}

// Unit normal of the face of the voxel, or cube, that the ray entered.
SVDAG_HD inline Vec3 face_normal(const Hit& hit, const Vec3& direction) {
  Vec3 normal{};
  normal[hit.axis] = direction[hit.axis] < 0 ? 1 : -1;
  return normal;
}

// Unit normal at the hit, on the side from which the ray came. If a cut ended the ray above the
// voxels, the normal is the entered face's.
//
// The side is where the ray is a voxel before the hit, relative to the mean of the voxels: at the
// rim of a shape, the ray is nearly in the surface, and its direction would not decide.
SVDAG_HD inline Vec3 surface_normal(const DagView& dag, const Hit& hit, const Ray& ray) {
  constexpr double kBefore = 1;
  Vec3 normal = face_normal(hit, ray.direction);
  if (hit.level != dag.levels) return normal;
  const Moments moments = moments_around(dag, hit.voxel);
  double m[3][3], axes[3][3];
  for (int i = 0; i < 9; ++i) m[i / 3][i % 3] = moments.covariance(i / 3, i % 3);
  diagonalize(m, axes);
  int thinnest = 0;
  for (int a = 1; a < 3; ++a) thinnest = m[a][a] < m[thinnest][thinnest] ? a : thinnest;
  const int one = (thinnest + 1) % 3, two = (thinnest + 2) % 3;
  const double middle = m[one][one] < m[two][two] ? m[one][one] : m[two][two];
  // A sheet: thin in one direction, wide in the two others.
  if (!(m[thinnest][thinnest] < 0.7 * middle)) return normal;
  normal = {{axes[0][thinnest], axes[1][thinnest], axes[2][thinnest]}};
  Vec3 before = ray.origin + ray.direction * (hit.t - kBefore);
  for (int a = 0; a < 3; ++a)
    before[a] -= hit.voxel[a] + 0.5 + double(moments.first[a]) / moments.count;
  return dot(normal, before) < 0 ? normal * -1 : normal;
}

}  // namespace svdag
