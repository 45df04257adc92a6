// A random number generator with the same results on every standard library, which std::uniform_*
// does not guarantee.
#pragma once

#include <cstdint>
#include <random>

namespace svdag {

class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  // Uniform in 0 .. n-1.
  uint64_t below(uint64_t n) { return uint64_t(UInt128(engine_()) * n >> 64); }
  // Uniform in [0, 1).
  double unit() { return double(engine_() >> 11) * 0x1p-53; }

 private:
  __extension__ typedef unsigned __int128 UInt128;
  std::mt19937_64 engine_;
};

}  // namespace svdag
