#include "io/affine.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <vector>

#include "io/units.h"
#include "streaming/error.h"

namespace svdag {
namespace {

double determinant(const Affine& a) {
  const auto& [p, q, r] = a.m;
  return (p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0])) +
         p[2] * (q[0] * r[1] - q[1] * r[0]);
}

// Returns nothing if `text` is not a list of numbers separated by commas.
std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> numbers;
  const char *at = text.data(), *const end = at + text.size();
  for (;;) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc()) return {};
    numbers.push_back(value);
    if (stop == end) return numbers;
    if (*stop != ',') return {};
    at = stop + 1;
  }
}

}  // namespace

bool is_invertible(const Affine& a) {
  for (const auto& row : a.m) {
    for (const double v : row) {
      if (!std::isfinite(v)) return false;
    }
  }
  return std::isnormal(determinant(a));
}

bool is_mirror(const Affine& a) {
  return determinant(a) < 0;
}

double axis_stretch(const Affine& a) {
  double longest = 0;
  for (size_t c = 0; c < 3; ++c) {
    const double square = (a.m[0][c] * a.m[0][c] + a.m[1][c] * a.m[1][c]) + a.m[2][c] * a.m[2][c];
    longest = std::max(longest, square);
  }
  return std::sqrt(longest);
}

Affine compose(const Affine& parent, const Affine& local) {
  Affine result;
  for (int r = 0; r < 3; ++r) {
    const auto& p = parent.m[r];
    for (int c = 0; c < 4; ++c) {
      result.m[r][c] = (p[0] * local.m[0][c] + p[1] * local.m[1][c]) + p[2] * local.m[2][c];
    }
    result.m[r][3] += p[3];
  }
  return result;
}

Affine scaling(double factor) {
  return {{{{factor, 0, 0, 0}, {0, factor, 0, 0}, {0, 0, factor, 0}}}};
}

Affine parse_transform(const std::string& text) {
  const std::vector<double> n = numbers_in(text);
  const bool whole = n.size() == 16 && n[12] == 0 && n[13] == 0 && n[14] == 0 && n[15] == 1;
  if (n.size() != 12 && !whole)
    fail_usage("--transform: \"" + text +
               "\" is not 16 numbers m00,m01,...,m33, row by row, of which the last four are "
               "0,0,0,1 or left out");
  Affine a;
  for (size_t i = 0; i < 12; ++i) a.m[i / 4][i % 4] = n[i];
  if (!is_invertible(a))
    fail_usage("--transform: the matrix flattens the scene: give one with an inverse");
  return a;
}

Affine parse_up(const std::string& axis) {
  // Rotations about x or z, so that no axis is mirrored.
  if (axis == "y") return {};
  if (axis == "-y") return {{{{1, 0, 0, 0}, {0, -1, 0, 0}, {0, 0, -1, 0}}}};
  if (axis == "z") return {{{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, -1, 0, 0}}}};
  if (axis == "-z") return {{{{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}}}};
  if (axis == "x") return {{{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}}}};
  if (axis == "-x") return {{{{0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}}}};
  fail_usage("--up: \"" + axis + "\" is not an axis: choose x, y, z, -x, -y or -z");
}

std::string format_transform(const Affine& a) {
  std::string text;
  for (const auto& row : a.m) {
    for (const double v : row) text += (text.empty() ? "" : ",") + format_double(v);
  }
  return text;
}

}  // namespace svdag
