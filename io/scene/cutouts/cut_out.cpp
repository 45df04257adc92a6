#include "io/scene/cutouts/cut_out.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace svdag {
namespace {

constexpr double kMargin = 0x1p-20;      // texels around a polygon
constexpr int kMaxRectangles = 1 << 14;  // looked at for one polygon

OpacityMap::Rectangle cells_of(const CutOut& cut, const TextureBox& box) noexcept {
  return {cut.map->cells(box.low.u, box.high.u), cut.map->cells(box.low.v, box.high.v)};
}

double texel(const CutOut& cut, int64_t i, int64_t j) noexcept {
  return double(cut.image->at(wrapped(i, cut.image->width(), cut.wrap_u),
                              wrapped(j, cut.image->height(), cut.wrap_v)));
}

// The part of the polygon with sign * (coordinate - limit) >= 0.
TexturePolygon clipped(const TexturePolygon& polygon, double TexturePoint::*axis, double limit,
                       double sign) noexcept {
  TexturePolygon out;
  for (size_t i = 0; i < polygon.size; ++i) {
    const TexturePoint& p = polygon.corners[i];
    const TexturePoint& q = polygon.corners[i + 1 == polygon.size ? 0 : i + 1];
    const double a = sign * (p.*axis - limit), b = sign * (q.*axis - limit);
    if (a >= 0) out.add(p);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) {
      const double t = a / (a - b);
      TexturePoint crossing = {p.u + (q.u - p.u) * t, p.v + (q.v - p.v) * t};
      crossing.*axis = limit;
      out.add(crossing);
    }
  }
  return out;
}

// The alpha between four texels, x and y from the centre of the first.
struct Bilinear {
  double a, b, c, d, least, largest;

  double at(double x, double y) const noexcept {
    return std::clamp(a + b * x + c * y + d * x * y, least, largest);
  }
};

Bilinear bilinear(const CutOut& cut, int64_t i, int64_t j) noexcept {
  const double a00 = texel(cut, i, j), a10 = texel(cut, i + 1, j), a01 = texel(cut, i, j + 1),
               a11 = texel(cut, i + 1, j + 1);
  return {a00,
          a10 - a00,
          a01 - a00,
          a00 - a10 - a01 + a11,
          std::min({a00, a10, a01, a11}),
          std::max({a00, a10, a01, a11})};
}

double largest_alpha(const CutOut& cut, int64_t i, int64_t j,
                     const TexturePolygon& polygon) noexcept {
  const Bilinear f = bilinear(cut, i, j);
  const double u0 = double(i) + 0.5, v0 = double(j) + 0.5;
  double largest = 0;
  for (size_t k = 0; k < polygon.size; ++k) {
    const TexturePoint& p = polygon.corners[k];
    const TexturePoint& q = polygon.corners[k + 1 == polygon.size ? 0 : k + 1];
    const double x = p.u - u0, y = p.v - v0, dx = q.u - p.u, dy = q.v - p.v;
    largest = std::max(largest, f.at(x, y));
    const double square = f.d * dx * dy;
    if (square >= 0) continue;
    const double t = (f.b * dx + f.c * dy + f.d * (x * dy + y * dx)) / (-2 * square);
    if (t > 0 && t < 1) largest = std::max(largest, f.at(x + dx * t, y + dy * t));
  }
  return largest;
}

// Whether a point of the polygon, which lies in the cells `all`, is opaque.
bool search(const CutOut& cut, const TexturePolygon& polygon, const OpacityMap::Rectangle& all,
            int* left) noexcept {
  if (polygon.size == 0) return false;
  OpacityMap::Rectangle cells = cells_of(cut, bounds_of(polygon));
  cells.u = {std::max(cells.u.first, all.u.first), std::min(cells.u.last, all.u.last)};
  cells.v = {std::max(cells.v.first, all.v.first), std::min(cells.v.last, all.v.last)};
  // What is only on their border is in the next cells, too.
  if (cells.u.first > cells.u.last || cells.v.first > cells.v.last) return false;
  const Opacity opacity = cut.map->opacity(cells);
  if (opacity == Opacity::kTransparent) return false;
  if (opacity == Opacity::kOpaque || --*left < 0) return true;
  const int64_t columns = cells.u.last - cells.u.first, rows = cells.v.last - cells.v.first;
  // A single texel is decided, so this is a cell between four.
  if (columns == 0 && rows == 0)
    return largest_alpha(cut, cells.u.first, cells.v.first, polygon) >= cut.threshold;
  const bool by_u = columns >= rows;
  const OpacityMap::Interval whole = by_u ? cells.u : cells.v;
  const int64_t middle = whole.first + (whole.last - whole.first) / 2;
  const double limit = double(middle + 1) + (cut.nearest ? 0 : 0.5);
  double TexturePoint::*axis = by_u ? &TexturePoint::u : &TexturePoint::v;
  OpacityMap::Rectangle lower = cells, upper = cells;
  (by_u ? lower.u : lower.v).last = middle;
  (by_u ? upper.u : upper.v).first = middle + 1;
  return search(cut, clipped(polygon, axis, limit, -1), lower, left) ||
         search(cut, clipped(polygon, axis, limit, 1), upper, left);
}

// One or two cells in each direction, decided by the slopes between their texels.
Opacity opacity_of_few(const CutOut& cut, const OpacityMap::Rectangle& cells,
                       const TexturePoint& centre, double half_u, double half_v) noexcept {
  constexpr double kRounding = 0x1p-20;  // of an alpha
  const int columns = int(cells.u.last - cells.u.first) + 2;
  const int rows = int(cells.v.last - cells.v.first) + 2;
  double alpha[3][3];
  double slope_u = 0, slope_v = 0;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const double a = alpha[j][i] = texel(cut, cells.u.first + i, cells.v.first + j);
      if (i > 0) slope_u = std::max(slope_u, std::abs(a - alpha[j][i - 1]));
      if (j > 0) slope_v = std::max(slope_v, std::abs(a - alpha[j - 1][i]));
    }
  }
  const double x = centre.u - 0.5 - double(cells.u.first),
               y = centre.v - 0.5 - double(cells.v.first);
  const int i = std::clamp(int(x), 0, columns - 2), j = std::clamp(int(y), 0, rows - 2);
  const double s = x - i, t = y - j;
  const double above = alpha[j][i] + (alpha[j][i + 1] - alpha[j][i]) * s;
  const double below = alpha[j + 1][i] + (alpha[j + 1][i + 1] - alpha[j + 1][i]) * s;
  const double middle = above + (below - above) * t;
  const double reach = slope_u * half_u + slope_v * half_v + kRounding;
  if (middle - reach >= cut.threshold) return Opacity::kOpaque;
  return middle + reach < cut.threshold ? Opacity::kTransparent : Opacity::kMixed;
}

}  // namespace

CutOut with_map(CutOut cut) {
  cut.map =
      std::make_shared<OpacityMap>(*cut.image, cut.wrap_u, cut.wrap_v, cut.nearest, cut.threshold);
  return cut;
}

TextureBox bounds_of(const TexturePolygon& polygon) noexcept {
  TextureBox box = {polygon.corners[0], polygon.corners[0]};
  for (size_t i = 1; i < polygon.size; ++i) {
    const TexturePoint& p = polygon.corners[i];
    box.low = {std::min(box.low.u, p.u), std::min(box.low.v, p.v)};
    box.high = {std::max(box.high.u, p.u), std::max(box.high.v, p.v)};
  }
  return box;
}

Opacity opacity_near(const CutOut& cut, const TexturePoint& centre, double half_u, double half_v,
                     OpacityMap::Blocks* blocks) noexcept {
  half_u += kMargin;
  half_v += kMargin;
  const OpacityMap::Rectangle cells = cells_of(
      cut, {{centre.u - half_u, centre.v - half_v}, {centre.u + half_u, centre.v + half_v}});
  const Opacity opacity = cut.map->opacity(cells, blocks);
  if (opacity == Opacity::kMixed && !cut.nearest && cells.u.last - cells.u.first <= 1 &&
      cells.v.last - cells.v.first <= 1)
    return opacity_of_few(cut, cells, centre, half_u, half_v);
  return opacity;
}

// A bilinear function is largest at a corner of a rectangle.
double largest_alpha_in_box(const CutOut& cut, int64_t i, int64_t j,
                            const TextureBox& box) noexcept {
  const Bilinear f = bilinear(cut, i, j);
  const double u = double(i) + 0.5, v = double(j) + 0.5;
  const double x0 = std::clamp(box.low.u - kMargin - u, 0.0, 1.0);
  const double x1 = std::clamp(box.high.u + kMargin - u, 0.0, 1.0);
  const double y0 = std::clamp(box.low.v - kMargin - v, 0.0, 1.0);
  const double y1 = std::clamp(box.high.v + kMargin - v, 0.0, 1.0);
  return std::max({f.at(x0, y0), f.at(x1, y0), f.at(x0, y1), f.at(x1, y1)});
}

bool has_opaque_point(const CutOut& cut, const TexturePolygon& polygon) noexcept {
  if (polygon.size == 0) return false;
  TexturePoint middle = {0, 0};
  for (size_t i = 0; i < polygon.size; ++i) {
    middle.u += polygon.corners[i].u;
    middle.v += polygon.corners[i].v;
  }
  middle = {middle.u / double(polygon.size), middle.v / double(polygon.size)};
  if (alpha_at(cut, middle) >= cut.threshold) return true;
  int left = kMaxRectangles;
  return search(cut, polygon, cells_of(cut, bounds_of(polygon)), &left);
}

double alpha_at(const CutOut& cut, const TexturePoint& p) noexcept {
  const OpacityMap::Rectangle cells = cells_of(cut, {p, p});
  if (cut.nearest) return texel(cut, cells.u.first, cells.v.first);
  return bilinear(cut, cells.u.first, cells.v.first)
      .at(p.u - 0.5 - double(cells.u.first), p.v - 0.5 - double(cells.v.first));
}

}  // namespace svdag
