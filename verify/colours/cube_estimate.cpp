#include "verify/colours/cube_estimate.h"

#include <algorithm>
#include <cmath>

#include "verify/sample/window_triangles.h"

namespace svdag {
namespace {

constexpr double kTouches = 0x1p-20;  // of a side: a triangle as near as that may meet the cube
constexpr double kSmallPart = 1.0 / 8;
constexpr double kStandardErrors = 4;
constexpr double kMoved = 1.5;

Point cross_product(const Point& p, const Point& q) {
  return {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
}

double length_of(const Point& p) {
  return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

// A triangle in units of a cube, relative to its corner.
class PlacedTriangle {
 public:
  PlacedTriangle(const JudgedTriangle& t, const LatticePoint& corner, int64_t side) : t_(t) {
    for (size_t k = 0; k < 3; ++k) v_[k] = Point(t.corners[k] - corner) / double(side);
    e1_ = v_[1] - v_[0];
    e2_ = v_[2] - v_[0];
    normal_ = cross_product(e1_, e2_);
    for (int a = 1; a < 3; ++a) {
      if (std::abs(normal_[a]) > std::abs(normal_[axis_])) axis_ = a;
    }
  }

  const std::array<Point, 3>& corners() const { return v_; }
  // The axis along which it is seen largest.
  int axis() const { return axis_; }
  bool has_area() const { return normal_[axis_] != 0; }

  // How far from a point, in texels of the finest level, the level that defines its colour mixes
  // others in: half of what the cube spans, from four texels on. Texels that are squares are
  // defined by the bilinear mean where the cube spans two or more.
  double reach() const {
    if (t_.texture == nullptr) return 0;
    const TexturePoint &a = t_.points[0], &b = t_.points[1], &c = t_.points[2];
    const double range = std::max(std::max({a.u, b.u, c.u}) - std::min({a.u, b.u, c.u}),
                                  std::max({a.v, b.v, c.v}) - std::min({a.v, b.v, c.v}));
    const double span = std::min(range, stretch());
    if (span >= 4) return span / 2;
    return t_.paint->nearest && span >= 2 ? 0.5 : 0;
  }

  // Of a polygon of the plane in the triangle, in texels; the triangle has a texture.
  TexturePolygon places_of(const Polygon& part) const {
    TexturePolygon places;
    for (const Point& p : part) places.add(place(weights(p)));
    return places;
  }

  // The colour at a point of the plane near the triangle, with its texture moved.
  WeightedColour at(const Point& p, double du, double dv) const {
    const Weights w = weights(p);
    if (t_.paint == nullptr) return {1, t_.colour[0], t_.colour[1], t_.colour[2]};
    WeightedColour colour{1, 1, 1, 1};
    if (t_.texture != nullptr) {
      const TexturePoint at = place(w);
      colour = t_.texture->at(*t_.paint, at.u + du, at.v + dv);
    }
    for (size_t c = 0; c < 3; ++c)
      colour[c + 1] *= t_.paint->factor[c] / 65535 *
                       w.mix(double(t_.corner_colours[0][c]), double(t_.corner_colours[1][c]),
                             double(t_.corner_colours[2][c]));
    return colour;
  }

 private:
  // Of the corners, at a point.
  struct Weights {
    double second, third;
    double mix(double a, double b, double c) const {
      return a * (1 - second - third) + b * second + c * third;
    }
  };
  Weights weights(const Point& p) const {
    const int i = (axis_ + 1) % 3, j = (axis_ + 2) % 3;
    const Point d = p - v_[0];
    const double n = normal_[axis_];
    const double second = std::clamp((d[i] * e2_[j] - d[j] * e2_[i]) / n, 0.0, 1.0);
    return {second, std::clamp((e1_[i] * d[j] - e1_[j] * d[i]) / n, 0.0, 1.0 - second)};
  }
  TexturePoint place(const Weights& w) const {
    const TexturePoint &a = t_.points[0], &b = t_.points[1], &c = t_.points[2];
    return {w.mix(a.u, b.u, c.u), w.mix(a.v, b.v, c.v)};
  }
  // The larger singular value of the map from the plane to texels.
  double stretch() const {
    const double x1 = length_of(e1_), h = length_of(normal_) / x1;
    if (!(h > 0)) return INFINITY;
    const double x2 = (e1_.x * e2_.x + e1_.y * e2_.y + e1_.z * e2_.z) / x1;
    const auto gradient = [&](double a, double b, double c) {
      const double along = (b - a) / x1;
      return std::array<double, 2>{along, ((c - a) - along * x2) / h};
    };
    const auto u = gradient(t_.points[0].u, t_.points[1].u, t_.points[2].u);
    const auto v = gradient(t_.points[0].v, t_.points[1].v, t_.points[2].v);
    const double xx = u[0] * u[0] + v[0] * v[0], yy = u[1] * u[1] + v[1] * v[1];
    const double xy = u[0] * u[1] + v[0] * v[1];
    return std::sqrt((xx + yy) / 2 + std::hypot((xx - yy) / 2, xy));
  }

  const JudgedTriangle& t_;
  std::array<Point, 3> v_;
  Point e1_, e2_, normal_;
  int axis_ = 0;
};

}  // namespace

// The points drawn on a polygon, by their area, and the regression of what they have on where they
// are.
class CubeEstimate::PolygonSample {
 public:
  void add(const Point& p, int axis, double area, const WeightedColour& y) {
    const std::array<double, 3> x{1, p[(axis + 1) % 3], p[(axis + 2) % 3]};
    for (size_t a = 0; a < 3; ++a) {
      for (size_t b = 0; b < 3; ++b) xx_[a][b] += area * x[a] * x[b];
      for (size_t c = 0; c < 4; ++c) xy_[a][c] += area * x[a] * y[c];
    }
    for (size_t c = 0; c < 4; ++c) {
      own_[c] += area * y[c] * y[c];
      with_weight_[c] += area * y[0] * y[c];
    }
    ++points_;
  }

  double area() const { return xx_[0][0]; }
  double points() const { return double(points_); }
  const std::array<double, 4>& sum() const { return xy_[0]; }

  // Of the colour as points of the definition give it, and of sum() / area(). The linear part of
  // what they have is left out for the former, and for the latter remains within a stratum.
  Moments variance(bool is_summed) const {
    const double few = is_summed ? INFINITY : area() < kSmallPart ? 1 : 4;
    const double drawn = 1 / points();
    return moments(true, 1 / few + drawn, moments(false, 4 * drawn * drawn, {}));
  }

 private:
  // Adds `factor` times the moments of a point, `is_straightened`: without what is linear.
  Moments moments(bool is_straightened, double factor, Moments sum) const {
    const double all = area();
    // Covariances of position, and of position and values.
    const auto cov_xx = [&](size_t a, size_t b) {
      return xx_[a][b] / all - xx_[0][a] * xx_[0][b] / (all * all);
    };
    const auto cov_xy = [&](size_t a, size_t c) {
      return xy_[a][c] / all - xx_[0][a] * xy_[0][c] / (all * all);
    };
    const double pp = cov_xx(1, 1), qq = cov_xx(2, 2), pq = cov_xx(1, 2);
    const double det = pp * qq - pq * pq;
    const bool has_slope = is_straightened && points_ > 8 && det > 1e-6 * pp * qq && det > 0;
    const auto explained = [&](size_t c, size_t d) {
      if (!has_slope) return 0.0;
      const double pc = cov_xy(1, c), qc = cov_xy(2, c), pd = cov_xy(1, d), qd = cov_xy(2, d);
      return (pc * (qq * pd - pq * qd) + qc * (pp * qd - pq * pd)) / det;
    };
    const double lost = has_slope ? 3 : 1;  // degrees of freedom
    const double scale = points() > lost ? points() / (points() - lost) : 1;
    const auto left = [&](double product, size_t c, size_t d) {
      return (product / all - xy_[0][c] * xy_[0][d] / (all * all) - explained(c, d)) * scale;
    };
    sum.weight += factor * std::max(0.0, left(own_[0], 0, 0));
    for (size_t c = 0; c < 3; ++c) {
      sum.mixed[c] += factor * left(with_weight_[c + 1], 0, c + 1);
      sum.channel[c] += factor * std::max(0.0, left(own_[c + 1], c + 1, c + 1));
    }
    return sum;
  }

  std::array<std::array<double, 3>, 3> xx_{};
  std::array<std::array<double, 4>, 3> xy_{};
  std::array<double, 4> own_{}, with_weight_{};
  size_t points_ = 0;
};

void CubeEstimate::add(const JudgedTriangle& t, const LatticePoint& corner, int64_t side,
                       Random& random) {
  const PlacedTriangle placed(t, corner, side);
  const Polygon whole(placed.corners().begin(), placed.corners().end());
  const Polygon part = cut_to_box(whole, Point(0), Point(1));
  is_touched_ = is_touched_ || !part.empty() ||
                !cut_to_box(whole, Point(-kTouches), Point(1 + kTouches)).empty();
  if (part.size() < 3 || !placed.has_area()) return;
  if (t.texture != nullptr) decoder_error_ = std::max(decoder_error_, t.texture->decoder_error());
  const double reach = placed.reach();
  PolygonSample sample;
  std::array<WeightedColour, 4> moved{};
  for (size_t k = 1; k + 1 < part.size(); ++k) {
    const Point p = part[k] - part[0], q = part[k + 1] - part[0];
    const double area = length_of(cross_product(p, q)) / 2;
    if (!(area > 0)) continue;
    // n rows of small triangles, all equal: 2 i + 1 in row i.
    const int n = std::clamp(int(std::ceil(std::sqrt(kPointsPerFace * area))), 4, 64);
    const double each = area / (n * n);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < 2 * i + 1; ++j) {
        double a = random.unit(), b = random.unit();
        if (a + b > 1) a = 1 - a, b = 1 - b;
        // Upwards: from (i, j/2) to row i + 1; downwards: the mirror image between two of these.
        const double row = j % 2 == 0 ? i + a + b : i + 1 - a - b;
        const double column = j % 2 == 0 ? j / 2 + b : j / 2 + 1 - b;
        const Point at = part[0] + (p * (row - column) + q * column) / double(n);
        const WeightedColour colour = placed.at(at, 0, 0);
        sample.add(at, placed.axis(), each, colour);
        for (size_t c = 0; c < 3 && colour[0] > 0; ++c) {
          low_[c] = std::min(low_[c], colour[c + 1] / colour[0]);
          high_[c] = std::max(high_[c], colour[c + 1] / colour[0]);
        }
        for (size_t d = 0; d < moved.size(); ++d) {
          const WeightedColour there =
              reach > 0 ? placed.at(at, (d % 2 == 0 ? reach : -reach) * random.unit(),
                                    (d / 2 == 0 ? reach : -reach) * random.unit())
                        : colour;
          for (size_t c = 0; c < 4; ++c) moved[d][c] += each * there[c];
        }
      }
    }
  }
  if (!(sample.area() > 0)) return;
  note_place(t.texture, t.texture != nullptr ? placed.places_of(part) : TexturePolygon());
  const bool is_summed = t.texture == nullptr || (t.paint->nearest && reach == 0);
  const Moments one = sample.variance(is_summed);
  const double share = sample.area() * sample.area();
  variance_.weight += share * one.weight;
  for (size_t c = 0; c < 3; ++c) {
    variance_.mixed[c] += share * one.mixed[c];
    variance_.channel[c] += share * one.channel[c];
  }
  for (size_t c = 0; c < 4; ++c) {
    sum_[c] += sample.sum()[c];
    for (size_t d = 0; d < moved.size(); ++d) moved_[d][c] += moved[d][c];
  }
}

void CubeEstimate::note_place(const JudgedTexture* texture, const TexturePolygon& part) {
  if (places_.count++ == 0) places_.texture = texture;
  if (texture != places_.texture) places_.is_mixed = true;
  if (texture == nullptr || places_.is_mixed) return;
  const TextureBox box = bounds_of(part);
  TextureBox& all = places_.box;
  all = places_.count == 1
            ? box
            : TextureBox{{std::min(all.low.u, box.low.u), std::min(all.low.v, box.low.v)},
                         {std::max(all.high.u, box.high.u), std::max(all.high.v, box.high.v)}};
  places_.sides.u += box.high.u - box.low.u;
  places_.sides.v += box.high.v - box.low.v;
}

bool CubeEstimate::is_at_seam() const {
  constexpr double kGap = 1;  // texel
  const auto& [texture, box, sides, is_mixed, count] = places_;
  return is_mixed || box.high.u - box.low.u > sides.u + kGap ||
         box.high.v - box.low.v > sides.v + kGap;
}

double CubeEstimate::tolerance(size_t channel) const {
  const double m = mean(channel);
  const double variance =
      variance_.channel[channel] - 2 * m * variance_.mixed[channel] + m * m * variance_.weight;
  const double error = kStandardErrors * std::sqrt(std::max(0.0, variance));
  // The least weight that the few points may have.
  const double weight = sum_[0] - kStandardErrors * std::sqrt(variance_.weight);
  const double range = std::max(m - low_[channel], high_[channel] - m);
  const double few = weight > 0 ? error / weight : range;
  double moved = 0;
  for (const WeightedColour& other : moved_)
    moved = std::max(moved, other[0] > kMinArea ? std::abs(other[channel + 1] / other[0] - m) : 1);
  return few + kMoved * moved;
}

}  // namespace svdag
