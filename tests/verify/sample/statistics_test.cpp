#include "verify/sample/statistics.h"

#include <gtest/gtest.h>

#include <cmath>

namespace svdag {
namespace {

TEST(Statistics, NothingWrongGivesTheRuleOfThree) {
  EXPECT_NEAR(rate_upper_bound(0, 100), 1 - std::pow(0.05, 0.01), 1e-12);
  EXPECT_NEAR(rate_upper_bound(0, 100000), 2.9957e-5, 1e-9);
}

// Closed form: k = n - 1 gives P(X <= k) = 1 - p^n.
TEST(Statistics, LastTrialHasAClosedForm) {
  for (const uint64_t n : {1U, 2U, 5U, 40U})
    EXPECT_NEAR(rate_upper_bound(n - 1, n), std::pow(0.95, 1 / double(n)), 1e-9) << n;
}

// Values of the beta quantile, from published tables: one-sided 95 % limits.
TEST(Statistics, AgreesWithTables) {
  EXPECT_NEAR(rate_upper_bound(1, 10), 0.39416, 1e-5);
  EXPECT_NEAR(rate_upper_bound(2, 10), 0.50690, 1e-5);
  EXPECT_NEAR(rate_upper_bound(5, 10), 0.77756, 1e-5);
}

TEST(Statistics, BoundIsWhereTheTailMeetsAlpha) {
  for (const uint64_t n : {10U, 100U, 20000U}) {
    for (const uint64_t k : {uint64_t(1), n / 10, n / 2}) {
      const double p = rate_upper_bound(k, n);
      double tail = 0;
      for (uint64_t i = 0; i <= k; ++i)
        tail += std::exp(std::lgamma(double(n) + 1) - std::lgamma(double(i) + 1) -
                         std::lgamma(double(n - i) + 1) + double(i) * std::log(p) +
                         double(n - i) * std::log1p(-p));
      EXPECT_NEAR(tail, 0.05, 1e-6) << k << " of " << n;
    }
  }
}

TEST(Statistics, WithoutTrialsTheBoundIsOne) {
  EXPECT_EQ(rate_upper_bound(0, 0), 1);
  EXPECT_EQ(rate_upper_bound(7, 7), 1);
}

}  // namespace
}  // namespace svdag
