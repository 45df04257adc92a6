#include "verify/sample/statistics.h"

#include <cmath>

namespace svdag {
namespace {

// P(X <= k) for X binomial (n, p), k/n <= p < 1. Terms decrease from k down, so the sum starts with
// the largest.
double lower_tail(uint64_t k, uint64_t n, double p) {
  const double nn = double(n), kk = double(k);
  double term = std::exp(std::lgamma(nn + 1) - std::lgamma(kk + 1) - std::lgamma(nn - kk + 1) +
                         kk * std::log(p) + (nn - kk) * std::log1p(-p));
  double sum = 0;
  for (double i = kk; i >= 0 && term > 0; --i) {
    sum += term;
    term *= i / (nn - i + 1) * (1 - p) / p;
    if (term < sum * 1e-18) break;
  }
  return sum;
}

}  // namespace

double rate_upper_bound(uint64_t wrong, uint64_t tested, double confidence) {
  if (wrong >= tested) return 1;
  const double alpha = 1 - confidence;
  if (wrong == 0) return -std::expm1(std::log(alpha) / double(tested));
  double low = double(wrong) / double(tested), high = 1;
  for (int i = 0; i < 100; ++i) {
    const double p = (low + high) / 2;
    if (p <= low || p >= high) break;
    (lower_tail(wrong, tested, p) >= alpha ? low : high) = p;
  }
  return high;
}

}  // namespace svdag
