// Bounds on a population's error rate that follow from a sample.
#pragma once

#include <cstdint>

namespace svdag {

// The exact (Clopper and Pearson 1934) upper bound on a rate: the largest p for which seeing at
// most `wrong` failures in `tested` independent trials has probability 1 - confidence or more.
// 0 wrong of n at 95 % gives 1 - 0.05^(1/n), the "rule of three". Without trials the bound is 1.
double rate_upper_bound(uint64_t wrong, uint64_t tested, double confidence = 0.95);

}  // namespace svdag
