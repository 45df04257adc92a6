// The voxel of a point on one axis: the floor of the exact rational
// (p * scale + offset - corner) / size.
//
// A floor in doubles decides all points except those within an error bound of a plane between
// voxels. For these the sign of p * scale + offset - corner - k * size decides, a sum of six
// doubles: products are split without error (Dekker 1971), and the sum is an expansion whose
// components do not overlap (Shewchuk 1997), so the largest one has its sign.
//
// Bound, u = 2^-53, M = |p scale| + |offset| + |corner|: three roundings of the numerator give 3uM,
// the rounded inverse and the product 2uM / size more. 8uM / size covers them.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace svdag {

// a * b as the sum of two doubles, the first of them the rounded product. Exact without overflow
// and underflow.
struct ExactProduct {
  double high, low;

  ExactProduct(double a, double b) noexcept : high(a * b) {
    const auto [a1, a2] = halves(a);
    const auto [b1, b2] = halves(b);
    low = a2 * b2 - (((high - a1 * b1) - a2 * b1) - a1 * b2);
  }

 private:
  static std::array<double, 2> halves(double a) noexcept {
    const double shifted = 0x8000001p0 * a;
    const double upper = shifted - (shifted - a);
    return {upper, a - upper};
  }
};

// Sign of the exact sum: -1, 0 or 1.
template <size_t kTerms>
int sign_of_sum(const std::array<double, kTerms>& terms) noexcept {
  std::array<double, kTerms> parts{};  // an expansion, smallest magnitude first
  size_t count = 0;
  for (double sum : terms) {
    for (size_t i = 0; i < count; ++i) {
      const double total = sum + parts[i], virtual_sum = total - parts[i];
      parts[i] = (parts[i] - (total - virtual_sum)) + (sum - virtual_sum);
      sum = total;
    }
    parts[count++] = sum;
  }
  while (count > 0 && parts[count - 1] == 0) --count;
  return count == 0 ? 0 : parts[count - 1] > 0 ? 1 : -1;
}

class ExactCell {
 public:
  // `max_point`: the largest magnitude of a p. All quotients must be below 2^48, else of() is not
  // exact; reach() is a bound of theirs.
  ExactCell(double scale, double offset, double corner, double size, double max_point) noexcept
      : scale_(scale), offset_(offset), corner_(corner), size_(size), inverse_(1 / size) {
    reach_ = (max_point * std::abs(scale) + std::abs(offset) + std::abs(corner)) / size;
    doubt_ = 0x1p-50 * reach_;
  }

  static constexpr double kMaxReach = 0x1p48;
  double reach() const noexcept { return reach_; }

  int64_t of(double p) const noexcept {
    const double q = (p * scale_ + offset_ - corner_) * inverse_;
    int64_t k = int64_t(q);
    k -= double(k) > q;
    const double fraction = q - double(k);
    if (fraction > doubt_ && fraction < 1 - doubt_) return k;
    while (is_below(p, k)) --k;
    while (!is_below(p, k + 1)) ++k;
    return k;
  }

 private:
  // Whether the point is below plane k.
  bool is_below(double p, int64_t k) const noexcept {
    const ExactProduct point(p, scale_), plane(-double(k), size_);
    return sign_of_sum<6>({point.low, plane.low, point.high, plane.high, offset_, -corner_}) < 0;
  }

  double scale_, offset_, corner_, size_, inverse_;
  double reach_, doubt_;
};

}  // namespace svdag
