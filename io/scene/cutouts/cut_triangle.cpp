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

CutPlane::CutPlane(const CutOut& cut, const CutTriangle& t, int64_t voxel) noexcept
    : cut_(&cut), margin_(kCutMargin * double(voxel)), start_(t.triangle.v[0]) {
  // Gradients: of u, ((u1 - u0) e2 x n + (u2 - u0) n x e1) / n.n with edges e from v0, n = e1 x e2.
  // Lost of their digits are 2 log2 of the sine between the edges, which is not less than 0.01.
  constexpr double kThinnest = 1e-4;  // the square of the sine between the edges
  TexturePolygon corners;
  for (const TexturePoint& p : t.corners) corners.add(p);
  box_ = bounds_of(corners);
  const auto& v = t.triangle.v;
  double e1[3], e2[3], n[3];
  double n2 = 0, l1 = 0, l2 = 0;
  for (int k = 0; k < 3; ++k) {
    e1[k] = double(v[1][k] - v[0][k]);
    e2[k] = double(v[2][k] - v[0][k]);
  }
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    n[k] = e1[p] * e2[q] - e1[q] * e2[p];
    n2 += n[k] * n[k];
    l1 += e1[k] * e1[k];
    l2 += e2[k] * e2[k];
  }
  if (!(n2 > kThinnest * l1 * l2)) return;
  is_linear_ = true;
  u_ = t.corners[0].u;
  v_ = t.corners[0].v;
  const double u1 = t.corners[1].u - u_, u2 = t.corners[2].u - u_;
  const double v1 = t.corners[1].v - v_, v2 = t.corners[2].v - v_;
  const double length = std::sqrt(n2), area = u1 * v2 - u2 * v1;
  is_invertible_ = area * area > kThinnest * (u1 * u1 + v1 * v1) * (u2 * u2 + v2 * v2);
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    normal_[k] = n[k] / length;
    edge_by_[1][k] = (e2[p] * n[q] - e2[q] * n[p]) / n2;
    edge_by_[2][k] = (n[p] * e1[q] - n[q] * e1[p]) / n2;
    edge_by_[0][k] = -edge_by_[1][k] - edge_by_[2][k];
    u_by_[k] = u1 * edge_by_[1][k] + u2 * edge_by_[2][k];
    v_by_[k] = v1 * edge_by_[1][k] + v2 * edge_by_[2][k];
    by_u_[k] = (v2 * e1[k] - v1 * e2[k]) / area;
    by_v_[k] = (u1 * e2[k] - u2 * e1[k]) / area;
  }
  edge_by_u_[1] = v2 / area, edge_by_v_[1] = -u2 / area;
  edge_by_u_[2] = -v1 / area, edge_by_v_[2] = u1 / area;
  edge_by_u_[0] = -edge_by_u_[1] - edge_by_u_[2];
  edge_by_v_[0] = -edge_by_v_[1] - edge_by_v_[2];
}

// A cube, relative to its centre.
struct CutPlane::InCube {
  double distance;     // of the centre from the plane
  TexturePoint foot;   // texture coordinates of the point of the plane that is next to the centre
  double inside[3];    // what a point may be away along each axis, and surely is in the cube
  int edges = 0;       // that meet the cube
  int edge[3];         // their numbers
  double edge_at[3];   // their barycentric coordinates at the foot
  double edge_in[3];   // where a point surely is in the triangle
};

// Looks at points of the plane on the line through the centre along the longest axis of the normal,
// and in the corners of the cube around it.
bool CutPlane::has_opaque_sample(const InCube& in) const noexcept {
  int w = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(normal_[k]) > std::abs(normal_[w])) w = k;
  }
  const int a = (w + 1) % 3, b = (w + 2) % 3;
  const auto height = [&](double x, double y) {
    return -(in.distance + normal_[a] * x + normal_[b] * y) / normal_[w];
  };
  const double middle = height(0, 0);
  const bool has_middle = std::abs(middle) <= in.inside[w];
  for (int n = has_middle ? 0 : 1; n < 5; ++n) {
    double p[3];
    p[a] = n == 0 ? 0 : (n & 1) != 0 ? in.inside[a] : -in.inside[a];
    p[b] = n == 0 ? 0 : n <= 2 ? in.inside[b] : -in.inside[b];
    p[w] = height(p[a], p[b]);
    if (std::abs(p[w]) > in.inside[w]) {
      if (!has_middle) continue;
      const double limit = std::copysign(in.inside[w], p[w]);
      const double t = 0.999 * (limit - middle) / (p[w] - middle);
      p[a] *= t;
      p[b] *= t;
      p[w] = middle + t * (p[w] - middle);
    }
    TexturePoint at = in.foot;
    for (int k = 0; k < 3; ++k) {
      at.u += u_by_[k] * p[k];
      at.v += v_by_[k] * p[k];
    }
    bool is_inside = true;
    for (int e = 0; e < in.edges; ++e) {
      const double* const by = edge_by_[in.edge[e]];
      is_inside &= in.edge_at[e] + by[0] * p[0] + by[1] * p[1] + by[2] * p[2] >= in.edge_in[e];
    }
    if (is_inside && alpha_at(*cut_, at) >= cut_->threshold + OpacityMap::kSurely) return true;
  }
  return false;
}

Opacity CutPlane::decide(const LatticePoint& corner, int64_t side, bool any) const noexcept {
  constexpr double kError = 0x1p-36;  // of a function, by the sizes of its terms
  const double half = double(side) / 2 + 2 * margin_;
  TextureBox box = box_;
  InCube in;
  in.distance = 0;
  in.foot = {u_, v_};
  double to[3], reach = 0;  // from v0 to the cube's centre
  if (is_linear_) {
    double half_u = std::abs(u_), half_v = std::abs(v_), span_u = 0, span_v = 0;
    for (int k = 0; k < 3; ++k) {
      to[k] = double(corner[k] - start_[k]) + double(side) / 2;
      reach += std::abs(to[k]);
      in.distance += normal_[k] * to[k];
      in.foot.u += u_by_[k] * to[k];
      in.foot.v += v_by_[k] * to[k];
      span_u += std::abs(u_by_[k]);
      span_v += std::abs(v_by_[k]);
    }
    half_u = span_u * half + (half_u + span_u * reach) * kError;
    half_v = span_v * half + (half_v + span_v * reach) * kError;
    box.low = {std::max(box.low.u, in.foot.u - half_u), std::max(box.low.v, in.foot.v - half_v)};
    box.high = {std::min(box.high.u, in.foot.u + half_u), std::min(box.high.v, in.foot.v + half_v)};
    if (box.low.u > box.high.u || box.low.v > box.high.v) return Opacity::kTransparent;
  }
  OpacityMap::Blocks blocks;
  const Opacity opacity =
      opacity_near(*cut_, {(box.low.u + box.high.u) / 2, (box.low.v + box.high.v) / 2},
                   (box.high.u - box.low.u) / 2, (box.high.v - box.low.v) / 2, &blocks);
  if (opacity != Opacity::kMixed || blocks.columns == 0 || !is_invertible_ || !is_linear_)
    return opacity;

  // Of the centre of the first block: its distances from the cube's centre, and its barycentric
  // coordinates. `near`: what a block may be away and still have a point in the cube (in the
  // triangle).
  const double du = blocks.u - in.foot.u, dv = blocks.v - in.foot.v;
  const double beyond = std::abs(du) + std::abs(dv) + 8 * blocks.size;
  double at[6], near[6], inside[6], by_column[6], by_row[6];
  for (int k = 0; k < 3; ++k) {
    const double span = std::abs(by_u_[k]) + std::abs(by_v_[k]);
    const double error = (reach + span * beyond) * kError;
    at[k] = by_u_[k] * du + by_v_[k] * dv - in.distance * normal_[k];
    by_column[k] = by_u_[k] * blocks.size;
    by_row[k] = by_v_[k] * blocks.size;
    near[k] = half + span * blocks.size / 2 + error;
    inside[k] = in.inside[k] = double(side) / 2 - error;
  }
  int tests = 3;
  for (int e = 0; e < 3; ++e) {
    double edge = edge_at_[e], span = 0;
    for (int k = 0; k < 3; ++k) {
      edge += edge_by_[e][k] * to[k];
      span += std::abs(edge_by_[e][k]);
    }
    const double in_texture = std::abs(edge_by_u_[e]) + std::abs(edge_by_v_[e]);
    const double error = (1 + span * reach + in_texture * beyond) * kError;
    if (edge - span * half > error) continue;  // the edge does not meet the cube
    in.edge[in.edges] = e;
    in.edge_at[in.edges] = edge;
    in.edge_in[in.edges++] = error;
    at[tests] = edge + edge_by_u_[e] * du + edge_by_v_[e] * dv;
    by_column[tests] = edge_by_u_[e] * blocks.size;
    by_row[tests] = edge_by_v_[e] * blocks.size;
    near[tests] = in_texture * blocks.size / 2 + span * 2 * margin_ + error;
    inside[tests] = error;
    ++tests;
  }
  const bool by_cells = any && blocks.size == 1 && !cut_->nearest;
  const double sample = blocks.sample / blocks.size;
  bool some = false, all = true;
  for (int j = 0; j < blocks.rows; ++j) {
    for (int i = 0; i < blocks.columns; ++i) {
      const uint32_t bits = blocks.bits[j] >> 8 * i;
      if (any && (bits & OpacityMap::kSome) == 0) continue;
      bool is_near = true, has_sample = (bits & OpacityMap::kSample) != 0;
      for (int k = 0; k < tests; ++k) {
        const double x = at[k] + i * by_column[k] + j * by_row[k];
        is_near &= k < 3 ? std::abs(x) <= near[k] : x >= -near[k];
        const double y = x + sample * (by_column[k] + by_row[k]);
        has_sample &= k < 3 ? std::abs(y) <= inside[k] : y >= inside[k];
      }
      if (any && has_sample) return Opacity::kOpaque;
      if (!is_near) continue;
      if (by_cells && !some &&
          largest_alpha_in_box(*cut_, int64_t(blocks.u) - 1 + i, int64_t(blocks.v) - 1 + j, box) <
              cut_->threshold)
        continue;
      some |= (bits & OpacityMap::kSome) != 0;
      all &= (bits & OpacityMap::kAll) != 0;
    }
  }
  if (!some) return Opacity::kTransparent;
  if (any) return has_opaque_sample(in) ? Opacity::kOpaque : Opacity::kMixed;
  return all ? Opacity::kOpaque : Opacity::kMixed;
}

}  // namespace svdag
