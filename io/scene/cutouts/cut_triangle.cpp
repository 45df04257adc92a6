#include "io/scene/cutouts/cut_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace svdag {
namespace {

struct TexturedPoint {
  double x[3];
  TexturePoint texture;
};

struct TexturedPolygon {
  std::array<TexturedPoint, 12> corners;  // a triangle that six planes cut has at most nine
  size_t size = 0;

  TexturedPolygon() {}  // NOLINT: = default would set all corners

  void add(const TexturedPoint& p) noexcept {
    if (size < corners.size()) corners[size++] = p;
  }
};

// *out: the part with sign * (x[axis] - limit) >= 0. Returns false, and leaves *out, if that is
// all.
bool clip(const TexturedPolygon& polygon, int axis, double limit, double sign,
          TexturedPolygon* out) noexcept {
  bool all = true;
  for (size_t i = 0; i < polygon.size; ++i) all &= sign * (polygon.corners[i].x[axis] - limit) >= 0;
  if (all) return false;
  out->size = 0;
  for (size_t i = 0; i < polygon.size; ++i) {
    const TexturedPoint& p = polygon.corners[i];
    const TexturedPoint& q = polygon.corners[i + 1 == polygon.size ? 0 : i + 1];
    const double a = sign * (p.x[axis] - limit), b = sign * (q.x[axis] - limit);
    if (a >= 0) out->add(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      const double t = a / (a - b);
      TexturedPoint crossing;
      for (int k = 0; k < 3; ++k) crossing.x[k] = p.x[k] + (q.x[k] - p.x[k]) * t;
      crossing.x[axis] = limit;
      crossing.texture = {p.texture.u + (q.texture.u - p.texture.u) * t,
                          p.texture.v + (q.texture.v - p.texture.v) * t};
      out->add(crossing);
    }
  }
  return true;
}

// The part in the box from low to high, relative to `corner`.
TexturePolygon part_in_box(const CutTriangle& t, const LatticePoint& corner, const double low[3],
                           const double high[3]) noexcept {
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const LatticePoint &p = t.triangle.v[size_t(a)], &q = t.triangle.v[size_t(b)];
    for (int k = 0; k < 3; ++k) {
      if (p[k] != q[k]) return p[k] < q[k];
    }
    return t.corners[size_t(a)] < t.corners[size_t(b)];
  });
  TexturedPolygon polygons[2];
  TexturedPolygon *polygon = &polygons[0], *next = &polygons[1];
  for (const int i : order) {
    TexturedPoint p;
    for (int k = 0; k < 3; ++k) p.x[k] = double(t.triangle.v[size_t(i)][k] - corner[k]);
    p.texture = t.corners[size_t(i)];
    polygon->add(p);
  }
  for (int k = 0; k < 3; ++k) {
    if (clip(*polygon, k, low[k], 1, next)) std::swap(polygon, next);
    if (clip(*polygon, k, high[k], -1, next)) std::swap(polygon, next);
  }
  TexturePolygon part;
  for (size_t i = 0; i < polygon->size; ++i) part.add(polygon->corners[i].texture);
  return part;
}

}  // namespace

// With twice the margin, so that the cube holds the boxes of its voxels in spite of rounding.
Opacity opacity_in_cube(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
                        int64_t side, int64_t voxel) noexcept {
  const double margin = 2 * kCutMargin * double(voxel), end = double(side) + margin;
  const double low[3] = {-margin, -margin, -margin}, high[3] = {end, end, end};
  const TexturePolygon part = part_in_box(t, corner, low, high);
  if (part.size == 0) return Opacity::kTransparent;
  const auto [low_uv, high_uv] = bounds_of(part);
  return opacity_near(cut, {(low_uv.u + high_uv.u) / 2, (low_uv.v + high_uv.v) / 2},
                      (high_uv.u - low_uv.u) / 2, (high_uv.v - low_uv.v) / 2);
}

bool is_opaque_in_voxel(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
                        int64_t voxel, bool thin) noexcept {
  const double margin = kCutMargin * double(voxel), end = double(voxel) + margin;
  const double middle = double(voxel) / 2;
  for (int w = 0; w < (thin ? 3 : 1); ++w) {
    double low[3] = {-margin, -margin, -margin}, high[3] = {end, end, end};
    for (int k = 0; thin && k < 3; ++k) {
      if (k == w) continue;
      low[k] = middle - margin;
      high[k] = middle + margin;
    }
    if (has_opaque_point(cut, part_in_box(t, corner, low, high))) return true;
  }
  return false;
}

CutPlane::CutPlane(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
                   int64_t voxel) noexcept
    : cut_(cut) {
  // Gradients: of u, ((u1 - u0) e2 x n + (u2 - u0) n x e1) / n.n with edges e from v0, n = e1 x e2.
  constexpr double kThinnest = 1e-8;  // the square of the sine between the edges
  constexpr double kError = 0x1p-36;  // of a coordinate, by its size
  const auto& v = t.triangle.v;
  double e1[3], e2[3], n[3], to_first[3];
  double reach = 0;
  for (int k = 0; k < 3; ++k) {
    e1[k] = double(v[1][k] - v[0][k]);
    e2[k] = double(v[2][k] - v[0][k]);
    to_first[k] = double(corner[k] - v[0][k]) + double(voxel) / 2;
    reach += std::abs(to_first[k]) + 8 * double(voxel);
  }
  double n2 = 0, l1 = 0, l2 = 0;
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    n[k] = e1[p] * e2[q] - e1[q] * e2[p];
    n2 += n[k] * n[k];
    l1 += e1[k] * e1[k];
    l2 += e2[k] * e2[k];
  }
  if (!(n2 > kThinnest * l1 * l2)) return;
  is_known_ = true;
  first_ = t.corners[0];
  half_u_ = half_v_ = 0;
  const double u1 = t.corners[1].u - t.corners[0].u, u2 = t.corners[2].u - t.corners[0].u;
  const double v1 = t.corners[1].v - t.corners[0].v, v2 = t.corners[2].v - t.corners[0].v;
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    const double e2n = e2[p] * n[q] - e2[q] * n[p], ne1 = n[p] * e1[q] - n[q] * e1[p];
    const double gu = (u1 * e2n + u2 * ne1) / n2, gv = (v1 * e2n + v2 * ne1) / n2;
    first_.u += gu * to_first[k];
    first_.v += gv * to_first[k];
    step_[k] = {gu * double(voxel), gv * double(voxel)};
    half_u_ += std::abs(gu);
    half_v_ += std::abs(gv);
  }
  const double size_u = std::abs(t.corners[0].u) + half_u_ * reach;
  const double size_v = std::abs(t.corners[0].v) + half_v_ * reach;
  const double half = double(voxel) * (0.5 + 2 * kCutMargin);
  half_u_ = half_u_ * half + size_u * kError;
  half_v_ = half_v_ * half + size_v * kError;
}

Opacity CutPlane::in_voxel(int x, int y, int z) const noexcept {
  if (!is_known_) return Opacity::kMixed;
  const TexturePoint centre = {first_.u + x * step_[0].u + y * step_[1].u + z * step_[2].u,
                               first_.v + x * step_[0].v + y * step_[1].v + z * step_[2].v};
  return opacity_near(cut_, centre, half_u_, half_v_);
}

}  // namespace svdag
