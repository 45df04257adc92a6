#include "io/scene/cutouts/cut_out.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace svdag {
namespace {

constexpr double kMargin = 0x1p-20;      // texels around a polygon
constexpr int kMaxRectangles = 1 << 14;  // looked at for one polygon

struct Interval {
  int64_t first, last;
};

// Texels of an image that hold those that [first, last] is wrapped to: one interval, or two.
int intervals(Interval texels, int64_t size, Wrap wrap, Interval out[2]) noexcept {
  if (texels.first >= 0 && texels.last < size) return out[0] = texels, 1;
  const int64_t a = wrapped(texels.first, size, wrap), b = wrapped(texels.last, size, wrap);
  if (wrap == Wrap::kClamp) return out[0] = {a, b}, 1;
  if (texels.last - texels.first >= size) return out[0] = {0, size - 1}, 1;
  const int64_t turn = floor_div(texels.last, size);
  if (turn == floor_div(texels.first, size)) return out[0] = {std::min(a, b), std::max(a, b)}, 1;
  if (wrap == Wrap::kRepeat) return out[0] = {a, size - 1}, out[1] = {0, b}, 2;
  out[0] = turn % 2 != 0 ? Interval{std::min(a, b), size - 1} : Interval{0, std::max(a, b)};
  return 1;
}

AlphaRange range_of(const CutOut& cut, Interval u, Interval v) noexcept {
  Interval columns[2], rows[2];
  const int n = intervals(u, cut.image->width(), cut.wrap_u, columns);
  const int m = intervals(v, cut.image->height(), cut.wrap_v, rows);
  AlphaRange range;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j)
      range.add(cut.image->range(columns[i].first, columns[i].last, rows[j].first, rows[j].last));
  }
  return range;
}

// A rectangle of cells; a cell of a bilinear texture reaches from the centre of a texel to the
// next.
struct Cells {
  Interval u, v;
};

Cells cells_of(const CutOut& cut, const TextureBox& box) noexcept {
  const double shift = cut.nearest ? 0 : 0.5;
  const auto cell = [&](double x) { return int64_t(std::floor(x - shift)); };
  return {{cell(box.low.u), cell(box.high.u)}, {cell(box.low.v), cell(box.high.v)}};
}

AlphaRange range_of(const CutOut& cut, const Cells& cells) noexcept {
  const int64_t next = cut.nearest ? 0 : 1;
  return range_of(cut, {cells.u.first, cells.u.last + next}, {cells.v.first, cells.v.last + next});
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
  const auto texel = [&](int64_t di, int64_t dj) {
    return double(cut.image->at(wrapped(i + di, cut.image->width(), cut.wrap_u),
                                wrapped(j + dj, cut.image->height(), cut.wrap_v)));
  };
  const double a00 = texel(0, 0), a10 = texel(1, 0), a01 = texel(0, 1), a11 = texel(1, 1);
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
bool search(const CutOut& cut, const TexturePolygon& polygon, const Cells& all,
            int* left) noexcept {
  if (polygon.size == 0) return false;
  Cells cells = cells_of(cut, bounds_of(polygon));
  cells.u = {std::max(cells.u.first, all.u.first), std::min(cells.u.last, all.u.last)};
  cells.v = {std::max(cells.v.first, all.v.first), std::min(cells.v.last, all.v.last)};
  // What is only on their border is in the next cells, too.
  if (cells.u.first > cells.u.last || cells.v.first > cells.v.last) return false;
  const AlphaRange range = range_of(cut, cells);
  if (range.largest < cut.threshold) return false;
  if (range.least >= cut.threshold || --*left < 0) return true;
  const int64_t columns = cells.u.last - cells.u.first, rows = cells.v.last - cells.v.first;
  // A single texel has a range of one alpha, so this is a cell between four.
  if (columns == 0 && rows == 0)
    return largest_alpha(cut, cells.u.first, cells.v.first, polygon) >= cut.threshold;
  const bool by_u = columns >= rows;
  const Interval whole = by_u ? cells.u : cells.v;
  const int64_t middle = whole.first + (whole.last - whole.first) / 2;
  const double limit = double(middle + 1) + (cut.nearest ? 0 : 0.5);
  double TexturePoint::*axis = by_u ? &TexturePoint::u : &TexturePoint::v;
  Cells lower = cells, upper = cells;
  (by_u ? lower.u : lower.v).last = middle;
  (by_u ? upper.u : upper.v).first = middle + 1;
  return search(cut, clipped(polygon, axis, limit, -1), lower, left) ||
         search(cut, clipped(polygon, axis, limit, 1), upper, left);
}

// One or two cells in each direction, decided by the slopes between their texels.
Opacity opacity_of_few(const CutOut& cut, const Cells& cells, const TexturePoint& centre,
                       double half_u, double half_v) noexcept {
  constexpr double kRounding = 0x1p-20;  // of an alpha
  const int64_t width = cut.image->width(), height = cut.image->height();
  const int columns = int(cells.u.last - cells.u.first) + 2;
  const int rows = int(cells.v.last - cells.v.first) + 2;
  int alpha[3][3];
  int least = 255, largest = 0, slope_u = 0, slope_v = 0;
  for (int j = 0; j < rows; ++j) {
    const int64_t row = wrapped(cells.v.first + j, height, cut.wrap_v);
    for (int i = 0; i < columns; ++i) {
      const int a = cut.image->at(wrapped(cells.u.first + i, width, cut.wrap_u), row);
      alpha[j][i] = a;
      least = std::min(least, a);
      largest = std::max(largest, a);
      if (i > 0) slope_u = std::max(slope_u, std::abs(a - alpha[j][i - 1]));
      if (j > 0) slope_v = std::max(slope_v, std::abs(a - alpha[j - 1][i]));
    }
  }
  if (least >= cut.threshold) return Opacity::kOpaque;
  if (largest < cut.threshold) return Opacity::kTransparent;
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

TextureBox bounds_of(const TexturePolygon& polygon) noexcept {
  TextureBox box = {polygon.corners[0], polygon.corners[0]};
  for (size_t i = 1; i < polygon.size; ++i) {
    const TexturePoint& p = polygon.corners[i];
    box.low = {std::min(box.low.u, p.u), std::min(box.low.v, p.v)};
    box.high = {std::max(box.high.u, p.u), std::max(box.high.v, p.v)};
  }
  return box;
}

bool is_opaque(const CutOut& cut) noexcept {
  const AlphaImage& image = *cut.image;
  return image.range(0, image.width() - 1, 0, image.height() - 1).least >= cut.threshold;
}

Opacity opacity_near(const CutOut& cut, const TexturePoint& centre, double half_u,
                     double half_v) noexcept {
  half_u += kMargin;
  half_v += kMargin;
  const Cells cells = cells_of(
      cut, {{centre.u - half_u, centre.v - half_v}, {centre.u + half_u, centre.v + half_v}});
  if (!cut.nearest && cells.u.last - cells.u.first <= 1 && cells.v.last - cells.v.first <= 1)
    return opacity_of_few(cut, cells, centre, half_u, half_v);
  const AlphaRange range = range_of(cut, cells);
  if (range.largest < cut.threshold) return Opacity::kTransparent;
  return range.least >= cut.threshold ? Opacity::kOpaque : Opacity::kMixed;
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
  const Cells cells = cells_of(cut, {p, p});
  if (cut.nearest) return range_of(cut, cells).least;
  return bilinear(cut, cells.u.first, cells.v.first)
      .at(p.u - 0.5 - double(cells.u.first), p.v - 0.5 - double(cells.v.first));
}

}  // namespace svdag
