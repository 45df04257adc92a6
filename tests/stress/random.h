// The random numbers of the stress suite: the same on every machine and with every standard library
// (the distributions of <random> are not). Separate from verify/sample/scene_draw.h, which draws
// samples from a user's seed, so that either can change without the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>

#include "io/triangle.h"

namespace svdag {

class StressRandom {
 public:
  explicit StressRandom(uint64_t seed) : bits_(seed) {}

  uint64_t below(uint64_t bound) { return bits_() % bound; }
  bool coin() { return bits_() >> 63 != 0; }
  // low <= value <= high
  int64_t between(int64_t low, int64_t high) {
    return low + int64_t(below(uint64_t(high - low) + 1));
  }
  int64_t around(int64_t reach) { return between(-reach, reach); }
  double unit() { return double(bits_() >> 11) * 0x1p-53; }
  // An integer in low .. high with a uniform logarithm; low >= 1.
  int64_t log_between(int64_t low, int64_t high) {
    int bits = 0;
    while ((low << (bits + 1)) > 0 && (low << (bits + 1)) <= high) ++bits;
    const int64_t base = low << between(0, bits);
    return std::min(high, base + int64_t(below(uint64_t(base))));
  }
  LatticePoint point(int64_t reach) { return {around(reach), around(reach), around(reach)}; }
  int axis() { return int(below(3)); }
  int64_t sign() { return coin() ? 1 : -1; }

 private:
  std::mt19937_64 bits_;
};

}  // namespace svdag
