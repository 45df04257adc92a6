#include "builder/colours/cube_share.h"

#include <algorithm>
#include <cmath>

namespace svdag {
namespace {

struct Vector {
  double x, y, z;

  double dot(const Vector& o) const { return (x * o.x + y * o.y) + z * o.z; }
};

// Vertices of a triangle differ by less than 2^63 on each axis, so products of two differences
// differ by less than 2^127.
__int128 cross(const LatticePoint& p, const LatticePoint& q, int i, int j) noexcept {
  return __int128(p[i]) * q[j] - __int128(p[j]) * q[i];
}

struct Frame {
  Vector e1, e2, n;  // edges from corner 0, and their cross product
};

Frame frame_of(const LatticePoint& p, const LatticePoint& q, double unit) noexcept {
  const double square = unit * unit;
  return {{double(p.x) * unit, double(p.y) * unit, double(p.z) * unit},
          {double(q.x) * unit, double(q.y) * unit, double(q.z) * unit},
          {double(cross(p, q, 1, 2)) * square, double(cross(p, q, 2, 0)) * square,
           double(cross(p, q, 0, 1)) * square}};
}

// The larger stretch of coordinates with differences du, dv along the edges: the larger singular
// value of their gradients, which lie in the plane.
double larger_stretch(const Frame& f, const double du[2], const double dv[2]) noexcept {
  const double square = f.n.dot(f.n);
  if (!(square > 0)) return 0;
  const auto turned = [&](const double d[2]) {
    return Vector{d[0] * f.e2.x - d[1] * f.e1.x, d[0] * f.e2.y - d[1] * f.e1.y,
                  d[0] * f.e2.z - d[1] * f.e1.z};
  };
  const Vector u = turned(du), v = turned(dv);
  const double uu = u.dot(u) / square, vv = v.dot(v) / square, uv = u.dot(v) / square;
  const double half = (uu - vv) / 2;
  return std::sqrt((uu + vv) / 2 + std::sqrt(half * half + uv * uv));
}

double range_of(double a, double b, double c) noexcept {
  return std::max(std::max(a, b), c) - std::min(std::min(a, b), c);
}

// The level of an image with `levels` levels where s texels of the finest are 2 to 4.
size_t level_for(double s, size_t levels) noexcept {
  if (!(s >= 4)) return 0;
  return std::min(size_t(std::ilogb(s) - 1), levels - 1);
}

// From coordinates in texels of the finest level to those of another one.
TexturePoint scale_to(const LinearImage& image, size_t level) noexcept {
  const auto& levels = image.levels();
  return {double(levels[level].width) / double(levels[0].width),
          double(levels[level].height) / double(levels[0].height)};
}

unsigned __int128 in_units(double value) noexcept {
  constexpr double kMost = 0x1p90;
  return (unsigned __int128)(std::min(value * 0x1p20, kMost) + 0.5);
}

}  // namespace

// Convex, in the projection. Five half planes add a corner each, and rounding perhaps a few more.
struct ShareSetup::Polygon {
  static constexpr int kMaxCorners = 16;
  double a[kMaxCorners], b[kMaxCorners];
  int size;

  void add(double at_a, double at_b) noexcept {
    if (size == kMaxCorners) return;
    a[size] = at_a;
    b[size++] = at_b;
  }
  // What of it is in the half plane by_a a + by_b b + base >= 0.
  void clip(double by_a, double by_b, double base, Polygon* out) const noexcept {
    double value[kMaxCorners];
    for (int k = 0; k < size; ++k) value[k] = by_a * a[k] + by_b * b[k] + base;
    out->size = 0;
    for (int k = 0; k < size; ++k) {
      const int l = k + 1 == size ? 0 : k + 1;
      if (value[k] >= 0) out->add(a[k], b[k]);
      if ((value[k] >= 0) == (value[l] >= 0)) continue;
      const double part = value[k] / (value[k] - value[l]);
      out->add(a[k] + (a[l] - a[k]) * part, b[k] + (b[l] - b[k]) * part);
    }
  }
};

ShareSetup::ShareSetup(const PaintedTriangle& t, const TriangleSetup& setup, const Paints& paints,
                       int side_log2) noexcept
    : side_log2_(side_log2),
      unit_(std::ldexp(1.0, -side_log2)),
      w_(setup.dominant),
      i_((w_ + 1) % 3),
      j_((w_ + 2) % 3),
      has_one_colour_(t.has_one_colour()),
      colour_(t.corners[0].colour) {
  for (size_t k = 0; k < 3; ++k) position_[k] = t.corners[k].position;
  const Frame f = frame_of(position_[1] - position_[0], position_[2] - position_[0], unit_);
  const double e1[3] = {f.e1.x, f.e1.y, f.e1.z}, e2[3] = {f.e2.x, f.e2.y, f.e2.z};
  const double n[3] = {f.n.x, f.n.y, f.n.z};
  determinant_ = n[w_];
  has_area_ = determinant_ != 0;
  for (int k = 0; k < 2; ++k) {
    to1_[k] = e1[k == 0 ? i_ : j_];
    to2_[k] = e2[k == 0 ? i_ : j_];
  }
  if (has_area_) {
    slope_a_ = -n[i_] / n[w_];
    slope_b_ = -n[j_] / n[w_];
    stretch_ = std::sqrt(f.n.dot(f.n)) / std::abs(n[w_]) * std::ldexp(1.0, kAreaBits);
    const double sign = determinant_ > 0 ? 1 : -1;
    for (int k = 0; k < 3; ++k) {
      const LatticePoint d = position_[(k + 1) % 3] - position_[k];
      edge_a_[k] = -sign * (double(d[j_]) * unit_);
      edge_b_[k] = sign * (double(d[i_]) * unit_);
    }
  }
  if (has_one_colour_) return;
  const Paint& paint = paints[t.paint];
  for (int c = 0; c < 3; ++c) {
    factor_[c] = paint.factor[size_t(c)] * kWhite16;
    for (size_t k = 0; k < 3; ++k)
      corner_colour_[c][k] = double(t.corners[k].colour[size_t(c)]) / kWhite16;
    has_colours_ |=
        corner_colour_[c][0] != 1 || corner_colour_[c][1] != 1 || corner_colour_[c][2] != 1;
    colours_[c] = interpolate(corner_colour_[c][0], corner_colour_[c][1], corner_colour_[c][2]);
  }
  if (!paint.image) return;
  has_texture_ = true;
  has_holes_ = paint.image->has_holes();
  const TexturePoint &p = t.corners[0].texture, &q = t.corners[1].texture,
                     &r = t.corners[2].texture;
  const double du[2] = {q.u - p.u, r.u - p.u}, dv[2] = {q.v - p.v, r.v - p.v};
  const double range = std::max(range_of(p.u, q.u, r.u), range_of(p.v, q.v, r.v));
  const double span = has_area_ ? std::min(larger_stretch(f, du, dv), range) : range;
  const auto& levels = paint.image->levels();
  paint_ = &paint;
  image_level_ = level_for(span, levels.size());
  has_squares_ = paint.nearest && span < 2;
  sampler_ = LevelSampler(paint, image_level_, has_squares_);
  for (size_t k = 0; k < 3; ++k) {
    corner_u_[k] = t.corners[k].texture.u;
    corner_v_[k] = t.corners[k].texture.v;
  }
  const auto [by_u, by_v] = scale_to(*paint.image, image_level_);
  u_ = interpolate(corner_u_[0] * by_u, corner_u_[1] * by_u, corner_u_[2] * by_u);
  v_ = interpolate(corner_v_[0] * by_v, corner_v_[1] * by_v, corner_v_[2] * by_v);
}

// The affine function of the projection with these values at the corners.
ShareSetup::Affine2 ShareSetup::interpolate(double at0, double at1, double at2) const noexcept {
  const double low = std::min(std::min(at0, at1), at2), high = std::max(std::max(at0, at1), at2);
  if (!has_area_) return {at0, 0, 0, low, high};
  const double d1 = at1 - at0, d2 = at2 - at0;
  return {at0, (d1 * to2_[1] - d2 * to1_[1]) / determinant_,
          (d2 * to1_[0] - d1 * to2_[0]) / determinant_, low, high};
}

// `colour`: of the corners, at the point.
inline ColourSum ShareSetup::sample_at(const LevelSampler& sampler, double u, double v,
                                       const double colour[3]) const noexcept {
  constexpr float kFull = kWhite16;
  ColourSum texel = has_texture_ ? sampler.at(u, v) : ColourSum{kFull, kFull, kFull, kFull};
  if (has_colours_) texel *= ColourSum{float(colour[0]), float(colour[1]), float(colour[2]), 1};
  return texel;
}

// a and b: relative to corner 0.
inline ColourSum ShareSetup::sample(double a, double b) const noexcept {
  const auto at = [&](const Affine2& f) {
    return std::min(std::max(f.base + (f.a * a + f.b * b), f.low), f.high);
  };
  double colour[3];
  if (has_colours_) {
    for (int c = 0; c < 3; ++c) colour[c] = at(colours_[c]);
  }
  return has_texture_ ? sample_at(sampler_, at(u_), at(v_), colour)
                      : sample_at(sampler_, 0, 0, colour);
}

// `sum`: of samples whose weights are, together, `weight`. `full`: the area in 2^-kAreaBits.
CubeShare ShareSetup::share_of(const ColourSum& sum, double full) const noexcept {
  CubeShare share;
  if (!(sum[3] > 0)) return share;
  share.area = uint64_t(full + 0.5);
  for (int c = 0; c < 3; ++c) {
    const double value = double(sum[c]) / double(sum[3]) * factor_[c] + 0.5;
    share.colour[size_t(c)] = value < kWhite16 ? uint16_t(value) : kWhite16;
  }
  return share;
}

// Adds the texels that are squares in a polygon, by their areas there. `at_a`, `at_b`: corner 0.
// False if there are too many: of a sliver, by rounding.
bool ShareSetup::add_squares(const Polygon& polygon, double at_a, double at_b,
                             ColourSum* sum) const noexcept {
  constexpr double kMost = 8;
  const auto first = [&](const Affine2& f, double* last) {
    double low = f.high, high = f.low;
    for (int k = 0; k < polygon.size; ++k) {
      const double value = f.base + (f.a * (polygon.a[k] - at_a) + f.b * (polygon.b[k] - at_b));
      low = std::min(low, value);
      high = std::max(high, value);
    }
    *last = std::floor(std::min(high, f.high));
    return std::floor(std::max(low, f.low));
  };
  double last_u, last_v;
  const double first_u = first(u_, &last_u), first_v = first(v_, &last_v);
  if (last_u - first_u > kMost || last_v - first_v > kMost) return false;
  // Of a polygon, what is in the texels `i` of a row or column `first` .. `last`.
  const auto slice = [&](const Polygon& whole, const Affine2& f, double i, double begin,
                         double end) {
    const double base = f.base - (f.a * at_a + f.b * at_b);
    Polygon part = whole, other;
    if (i != begin) {
      part.clip(f.a, f.b, base - i, &other);
      part = other;
    }
    if (i != end) {
      part.clip(-f.a, -f.b, i + 1 - base, &other);
      part = other;
    }
    return part;
  };
  for (double i = first_u; i <= last_u; ++i) {
    const Polygon column = slice(polygon, u_, i, first_u, last_u);
    for (double j = first_v; j <= last_v && column.size >= 3; ++j) {
      const Polygon cell = slice(column, v_, j, first_v, last_v);
      for (int k = 1; k + 1 < cell.size; ++k) {
        const double pa = cell.a[k] - cell.a[0], pb = cell.b[k] - cell.b[0];
        const double qa = cell.a[k + 1] - cell.a[0], qb = cell.b[k + 1] - cell.b[0];
        const double part = std::abs(pa * qb - pb * qa) / 2;
        if (!(part > 0)) continue;
        double colour[3];
        for (int c = 0; c < 3 && has_colours_; ++c) {
          const Affine2& f = colours_[c];
          const double a = cell.a[0] - at_a + (pa + qa) / 3, b = cell.b[0] - at_b + (pb + qb) / 3;
          colour[c] = std::min(std::max(f.base + (f.a * a + f.b * b), f.low), f.high);
        }
        *sum += sample_at(sampler_, i + 0.5, j + 0.5, colour) * float(part);
      }
    }
  }
  return true;
}

CubeShare ShareSetup::share_in(const LatticePoint& corner) const noexcept {
  if (!has_area_) return {0, has_one_colour_ ? colour_ : std::array<uint16_t, 3>{}};
  // Corners of the triangle in the projection, relative to that of the cube: exact.
  double at_a[3], at_b[3];
  for (int k = 0; k < 3; ++k) {
    at_a[k] = double(position_[k][i_] - corner[i_]) * unit_;
    at_b[k] = double(position_[k][j_] - corner[j_]) * unit_;
  }
  const double z =
      double(position_[0][w_] - corner[w_]) * unit_ - (slope_a_ * at_a[0] + slope_b_ * at_b[0]);
  const double z_low = z + std::min(slope_a_, 0.0) + std::min(slope_b_, 0.0);
  const double z_high = z + std::max(slope_a_, 0.0) + std::max(slope_b_, 0.0);
  double edge[3], edge_low[3];
  bool inside = z_low >= 0 && z_high <= 1;
  for (int k = 0; k < 3; ++k) {
    edge[k] = -(edge_a_[k] * at_a[k] + edge_b_[k] * at_b[k]);
    edge_low[k] = edge[k] + std::min(edge_a_[k], 0.0) + std::min(edge_b_[k], 0.0);
    inside &= edge_low[k] >= 0;
  }
  if (inside && !has_squares_) {
    if (has_one_colour_) return {uint64_t(stretch_ + 0.5), colour_};
    const double a = -at_a[0], b = -at_b[0];
    const ColourSum sum = (sample(a + 0.25, b + 0.25) + sample(a + 0.75, b + 0.25)) +
                          (sample(a + 0.25, b + 0.75) + sample(a + 0.75, b + 0.75));
    return share_of(sum,
                    has_holes_ ? stretch_ * (double(sum[3]) / (4 * double(kWhite16))) : stretch_);
  }
  Polygon first, second;
  first.size = 0;
  first.add(0, 0);
  first.add(1, 0);
  first.add(1, 1);
  first.add(0, 1);
  Polygon *polygon = &first, *next = &second;
  const auto clip = [&](double by_a, double by_b, double base) {
    polygon->clip(by_a, by_b, base, next);
    std::swap(polygon, next);
    return polygon->size >= 3;
  };
  if (z_low < 0 && !clip(slope_a_, slope_b_, z)) return {};
  if (z_high > 1 && !clip(-slope_a_, -slope_b_, 1 - z)) return {};
  for (int k = 0; k < 3; ++k) {
    if (edge_low[k] < 0 && !clip(edge_a_[k], edge_b_[k], edge[k])) return {};
  }
  double area = 0;
  ColourSum sum{};
  const bool is_summed = has_squares_ && add_squares(*polygon, at_a[0], at_b[0], &sum);
  const double a0 = polygon->a[0], b0 = polygon->b[0];
  for (int k = 1; k + 1 < polygon->size; ++k) {
    const double pa = polygon->a[k] - a0, pb = polygon->b[k] - b0;
    const double qa = polygon->a[k + 1] - a0, qb = polygon->b[k + 1] - b0;
    const double part = std::abs(pa * qb - pb * qa) / 2;
    if (!(part > 0)) continue;
    area += part;
    if (has_one_colour_ || is_summed) continue;
    const double a = a0 - at_a[0], b = b0 - at_b[0];
    if (part < 1.0 / 16) {
      sum += sample(a + (pa + qa) / 3, b + (pb + qb) / 3) * float(part);
    } else {
      const float quarter = float(part / 4);
      sum += sample(a + (pa + qa) / 3, b + (pb + qb) / 3) * quarter;
      sum += sample(a + (4 * pa + qa) / 6, b + (4 * pb + qb) / 6) * quarter;
      sum += sample(a + (pa + 4 * qa) / 6, b + (pb + 4 * qb) / 6) * quarter;
      sum += sample(a + (pa + qa) / 6, b + (pb + qb) / 6) * quarter;
    }
  }
  if (has_one_colour_) return {uint64_t(stretch_ * area + 0.5), colour_};
  const double opaque = has_holes_ ? std::min(double(sum[3]) / double(kWhite16), area) : area;
  return share_of(sum, stretch_ * opaque);
}

CubeShare ShareSetup::nearest_to_centre(const LatticePoint& corner) const noexcept {
  if (has_one_colour_) return {kWhite16, colour_};
  const int64_t half = int64_t(1) << (side_log2_ - 1);
  double p[3][3];  // corners relative to the centre
  for (int k = 0; k < 3; ++k) {
    for (int a = 0; a < 3; ++a) p[k][a] = double(position_[k][a] - corner[a] - half) * unit_;
  }
  const auto dot = [](const double* x, const double* y) {
    return (x[0] * y[0] + x[1] * y[1]) + x[2] * y[2];
  };
  // Weights of the corners at the nearest point: inside, or else on an edge.
  double best[3] = {1, 0, 0}, least = dot(p[0], p[0]);
  for (int k = 0; k < 3; ++k) {
    const int l = (k + 1) % 3;
    const double d[3] = {p[l][0] - p[k][0], p[l][1] - p[k][1], p[l][2] - p[k][2]};
    const double length = dot(d, d);
    const double part = length > 0 ? std::clamp(-dot(p[k], d) / length, 0.0, 1.0) : 0.0;
    const double at[3] = {p[k][0] + part * d[0], p[k][1] + part * d[1], p[k][2] + part * d[2]};
    if (dot(at, at) >= least) continue;
    least = dot(at, at);
    best[0] = best[1] = best[2] = 0;
    best[k] = 1 - part;
    best[l] = part;
  }
  if (has_area_) {
    const double e1[3] = {p[1][0] - p[0][0], p[1][1] - p[0][1], p[1][2] - p[0][2]};
    const double e2[3] = {p[2][0] - p[0][0], p[2][1] - p[0][1], p[2][2] - p[0][2]};
    const double a = dot(e1, e1), b = dot(e1, e2), c = dot(e2, e2);
    const double d1 = -dot(p[0], e1), d2 = -dot(p[0], e2), whole = a * c - b * b;
    const double s = (d1 * c - d2 * b) / whole, t = (d2 * a - d1 * b) / whole;
    if (s >= 0 && t >= 0 && s + t <= 1) {
      best[0] = 1 - s - t;
      best[1] = s;
      best[2] = t;
    }
  }
  const auto at = [&](const double v[3]) {
    const double value = (best[0] * v[0] + best[1] * v[1]) + best[2] * v[2];
    return std::clamp(value, std::min(std::min(v[0], v[1]), v[2]),
                      std::max(std::max(v[0], v[1]), v[2]));
  };
  double colour[3];
  for (int c = 0; c < 3; ++c) colour[c] = at(corner_colour_[c]);
  if (!has_texture_) return share_of(sample_at(sampler_, 0, 0, colour), kWhite16);
  const double u = at(corner_u_), v = at(corner_v_);
  const auto in_level = [&](size_t level, const LevelSampler& sampler) {
    const auto [by_u, by_v] = scale_to(*paint_->image, level);
    return sample_at(sampler, u * by_u, v * by_v, colour);
  };
  ColourSum sum = in_level(image_level_, sampler_);
  const double opacity = double(sum[3]);
  const size_t levels = paint_->image->levels().size();
  for (size_t level = image_level_; !(sum[3] > 0) && level < levels; ++level)
    sum = in_level(level, LevelSampler(*paint_, level, false));
  return share_of(sum, opacity);
}

void TexelDensity::add(const PaintedTriangle& t, int fraction) noexcept {
  if (t.has_one_colour()) return;
  const LatticePoint p = t.corners[1].position - t.corners[0].position;
  const LatticePoint q = t.corners[2].position - t.corners[0].position;
  const Frame f = frame_of(p, q, std::ldexp(1.0, -fraction));
  const double own_area = std::sqrt(f.n.dot(f.n)) / 2;
  const TexturePoint &a = t.corners[0].texture, &b = t.corners[1].texture,
                     &c = t.corners[2].texture;
  const double du[2] = {b.u - a.u, c.u - a.u}, dv[2] = {b.v - a.v, c.v - a.v};
  double stretch = larger_stretch(f, du, dv);
  if (own_area > 0 &&
      (t.corners[0].colour != t.corners[1].colour || t.corners[0].colour != t.corners[2].colour))
    stretch = std::max(stretch, 1 / std::sqrt(2 * own_area));
  texels += in_units(own_area * stretch);
  area += in_units(own_area);
}

}  // namespace svdag
