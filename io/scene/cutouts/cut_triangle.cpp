#include "io/scene/cutouts/cut_triangle.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace svdag {
namespace {

constexpr double kError = 0x1p-36;  // of a linear function, by the sizes of its terms

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
  box_ = {t.corners[0], t.corners[0]};
  for (const TexturePoint& p : t.corners) {
    box_.low = {std::min(box_.low.u, p.u), std::min(box_.low.v, p.v)};
    box_.high = {std::max(box_.high.u, p.u), std::max(box_.high.v, p.v)};
  }
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
  for (int k = 0; k < 3; ++k) {
    if (std::abs(normal_[k]) > std::abs(normal_[axis_])) axis_ = k;
    u_span_ += std::abs(u_by_[k]);
    v_span_ += std::abs(v_by_[k]);
    by_span_[k] = std::abs(by_u_[k]) + std::abs(by_v_[k]);
    for (int e = 0; e < 3; ++e) edge_span_[e] += std::abs(edge_by_[e][k]);
  }
  for (int k = 0; k < 3; ++k) {
    u_across_ += std::abs(u_by_[k] - u_by_[axis_] * (n[k] / n[axis_]));
    v_across_ += std::abs(v_by_[k] - v_by_[axis_] * (n[k] / n[axis_]));
  }
  edge_by_u_[1] = v2 / area, edge_by_v_[1] = -u2 / area;
  edge_by_u_[2] = -v1 / area, edge_by_v_[2] = u1 / area;
  edge_by_u_[0] = -edge_by_u_[1] - edge_by_u_[2];
  edge_by_v_[0] = -edge_by_v_[1] - edge_by_v_[2];
}

// A cube, relative to its centre.
struct CutPlane::InCube {
  double half;          // of a side, and twice the margin
  double reach = 0;     // the size of coordinates from v0
  double to[3];         // from v0 to the centre
  double distance = 0;  // of the centre from the plane
  TexturePoint foot;    // texture coordinates of the point of the plane that is next to the centre
  double inside;        // what a point may be away along each axis, and surely is in the cube
  int edges = 0;        // that meet the cube
  int edge[3];          // their numbers
  double edge_at[3];    // their barycentric coordinates at the foot
  double edge_error[3];
};

CutPlane::InCube CutPlane::place(const LatticePoint& corner, int64_t side) const noexcept {
  InCube in;
  in.half = double(side) / 2 + 2 * margin_;
  in.foot = {u_, v_};
  for (int k = 0; k < 3; ++k) {
    in.to[k] = double(corner[k] - start_[k]) + double(side) / 2;
    in.reach += std::abs(in.to[k]);
    in.distance += normal_[k] * in.to[k];
    in.foot.u += u_by_[k] * in.to[k];
    in.foot.v += v_by_[k] * in.to[k];
  }
  in.inside = double(side) / 2 - in.reach * kError;
  for (int e = 0; e < 3; ++e) {
    const double* const by = edge_by_[e];
    const double edge = edge_at_[e] + by[0] * in.to[0] + by[1] * in.to[1] + by[2] * in.to[2];
    const double error = (1 + edge_span_[e] * in.reach) * kError;
    if (edge - edge_span_[e] * in.half > error) continue;
    in.edge[in.edges] = e;
    in.edge_at[in.edges] = edge;
    in.edge_error[in.edges++] = error;
  }
  return in;
}

// Whether the triangle surely has the point of the plane that is p away from the centre; *at: its
// texture coordinates.
bool CutPlane::has_point(const InCube& in, const double p[3], TexturePoint* at) const noexcept {
  *at = {in.foot.u + u_by_[0] * p[0] + u_by_[1] * p[1] + u_by_[2] * p[2],
         in.foot.v + v_by_[0] * p[0] + v_by_[1] * p[1] + v_by_[2] * p[2]};
  bool is_inside = true;
  for (int e = 0; e < in.edges; ++e) {
    const double* const by = edge_by_[in.edge[e]];
    is_inside &= in.edge_at[e] + by[0] * p[0] + by[1] * p[1] + by[2] * p[2] >= in.edge_error[e];
  }
  return is_inside;
}

// Looks at the point of the plane on the line through the centre along the longest axis of the
// normal.
bool CutPlane::has_opaque_middle(const InCube& in) const noexcept {
  double p[3] = {0, 0, 0};
  p[axis_] = -in.distance / normal_[axis_];
  if (std::abs(p[axis_]) > in.inside) return false;
  TexturePoint at;
  return has_point(in, p, &at) && cut_->map->opacity_at(at.u, at.v) == Opacity::kOpaque;
}

// Looks at the points of the plane in the corners of the cube around that line.
bool CutPlane::has_opaque_corner(const InCube& in) const noexcept {
  const int w = axis_, a = (w + 1) % 3, b = (w + 2) % 3;
  const double middle = -in.distance / normal_[w];
  for (int n = 0; n < 5; ++n) {
    double p[3];
    p[a] = n == 4 ? 0 : (n & 1) != 0 ? in.inside : -in.inside;
    p[b] = n == 4 ? 0 : (n & 2) != 0 ? in.inside : -in.inside;
    p[w] = middle - (normal_[a] * p[a] + normal_[b] * p[b]) / normal_[w];
    if (std::abs(p[w]) > in.inside) {
      if (std::abs(middle) > in.inside) continue;
      const double limit = std::copysign(in.inside, p[w]);
      const double t = 0.999 * (limit - middle) / (p[w] - middle);
      p[a] *= t;
      p[b] *= t;
      p[w] = middle + t * (p[w] - middle);
    }
    TexturePoint at;
    if (has_point(in, p, &at) && alpha_at(*cut_, at) >= cut_->threshold + OpacityMap::kSurely)
      return true;
  }
  return false;
}

Opacity CutPlane::decide(const LatticePoint& corner, int64_t side, bool any) const noexcept {
  InCube in;
  TextureBox box = box_;
  if (is_linear_) {
    in = place(corner, side);
    if (any && has_opaque_middle(in)) return Opacity::kOpaque;
    const double error_u = (std::abs(u_) + (u_span_ + u_across_) * in.reach) * kError;
    const double error_v = (std::abs(v_) + (v_span_ + v_across_) * in.reach) * kError;
    const auto limit = [&](const TexturePoint& centre, double u_span, double v_span) {
      const double half_u = u_span * in.half + error_u, half_v = v_span * in.half + error_v;
      box.low = {std::max(box.low.u, centre.u - half_u), std::max(box.low.v, centre.v - half_v)};
      box.high = {std::min(box.high.u, centre.u + half_u), std::min(box.high.v, centre.v + half_v)};
    };
    limit(in.foot, u_span_, v_span_);
    const double middle = -in.distance / normal_[axis_];
    limit({in.foot.u + u_by_[axis_] * middle, in.foot.v + v_by_[axis_] * middle}, u_across_,
          v_across_);
    if (box.low.u > box.high.u || box.low.v > box.high.v) return Opacity::kTransparent;
  }
  OpacityMap::Blocks blocks;
  const Opacity opacity =
      opacity_near(*cut_, {(box.low.u + box.high.u) / 2, (box.low.v + box.high.v) / 2},
                   (box.high.u - box.low.u) / 2, (box.high.v - box.low.v) / 2, &blocks);
  if (opacity != Opacity::kMixed || !is_linear_) return opacity;
  if (blocks.columns > 0 && is_invertible_) {
    const Opacity by_blocks = decide_by_blocks(in, box, blocks, any);
    if (by_blocks != Opacity::kMixed) return by_blocks;
  }
  return any && has_opaque_corner(in) ? Opacity::kOpaque : Opacity::kMixed;
}

Opacity CutPlane::decide_by_blocks(const InCube& in, const TextureBox& box,
                                   const OpacityMap::Blocks& blocks, bool any) const noexcept {
  // Of the centre of the first block: its distances from the cube's centre along the axes, then its
  // barycentric coordinates. `near`: the largest distances (least coordinates) of a block that may
  // have a point in the cube and the triangle. `inside`: those of a point that surely is in both.
  const double du = blocks.u - in.foot.u, dv = blocks.v - in.foot.v, size = blocks.size;
  const double beyond = (std::abs(du) + std::abs(dv) + 16 * size) * kError;
  double at[6], near[6], inside[6], by_column[6], by_row[6];
  for (int k = 0; k < 3; ++k) {
    at[k] = by_u_[k] * du + by_v_[k] * dv - in.distance * normal_[k];
    by_column[k] = by_u_[k] * size;
    by_row[k] = by_v_[k] * size;
    near[k] = in.half + by_span_[k] * (size / 2 + beyond) + in.reach * kError;
    inside[k] = in.inside - by_span_[k] * beyond;
  }
  const int tests = 3 + in.edges;
  for (int k = 3; k < tests; ++k) {
    const int e = in.edge[k - 3];
    const double span = std::abs(edge_by_u_[e]) + std::abs(edge_by_v_[e]);
    at[k] = in.edge_at[k - 3] + edge_by_u_[e] * du + edge_by_v_[e] * dv;
    by_column[k] = edge_by_u_[e] * size;
    by_row[k] = edge_by_v_[e] * size;
    inside[k] = in.edge_error[k - 3] + span * beyond;
    near[k] = -(span * size / 2 + edge_span_[e] * 2 * margin_ + inside[k]);
  }
  // Whether point (i, j) of the texture, in blocks from the first centre, is within a bound.
  const auto is_within = [&](double i, double j, const double bound[6]) {
    for (int k = 0; k < tests; ++k) {
      const double x = at[k] + i * by_column[k] + j * by_row[k];
      if (k < 3 ? std::abs(x) > bound[k] : x < bound[k]) return false;
    }
    return true;
  };
  const bool by_cells = any && size == 1 && !cut_->nearest;
  const double sample = blocks.sample / size;
  bool some = false, all = true;
  for (int j = 0; j < blocks.rows; ++j) {
    const uint64_t row = blocks.bits[j];
    if (any) {
      for (uint64_t left = row & OpacityMap::kEach * OpacityMap::kSample; left != 0;
           left &= left - 1) {
        if (is_within(std::countr_zero(left) / 8 + sample, j + sample, inside))
          return Opacity::kOpaque;
      }
      for (uint64_t left = some ? 0 : row & OpacityMap::kEach * OpacityMap::kSome; left != 0;
           left &= left - 1) {
        const int i = std::countr_zero(left) / 8;
        if (!is_within(i, j, near)) continue;
        some = !by_cells || largest_alpha_in_box(*cut_, int64_t(blocks.u) - 1 + i,
                                                 int64_t(blocks.v) - 1 + j, box) >= cut_->threshold;
        if (some) break;
      }
    } else {
      for (int i = 0; i < blocks.columns; ++i) {
        const auto bits = uint8_t(row >> 8 * i);
        const bool adds = !some && (bits & OpacityMap::kSome) != 0;
        const bool takes = all && (bits & OpacityMap::kAll) == 0;
        if ((!adds && !takes) || !is_within(i, j, near)) continue;
        some |= adds;
        all &= !takes;
        if (some && !all) return Opacity::kMixed;
      }
    }
  }
  if (!some) return Opacity::kTransparent;
  return !any && all ? Opacity::kOpaque : Opacity::kMixed;
}

}  // namespace svdag
