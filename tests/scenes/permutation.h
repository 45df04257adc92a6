// A random-looking permutation of 0 .. n-1 that needs no memory.
//
// A Feistel network permutes the 2^b numbers of b bits, 2^(b-2) < n <= 2^b; numbers >= n are sent
// through it again until one falls below n ("cycle walking", Black and Rogaway 2002), on average
// less than four times. Both directions cost the same.
// Rejected: Fisher-Yates (holds the list), i * a mod n (neighbours stay recognisable).
#pragma once

#include <bit>
#include <cstdint>

#include "tests/scenes/numbers.h"

namespace svdag::scenes {

class Permutation {
 public:
  Permutation(uint64_t n, uint64_t seed)
      : n_(n), seed_(seed), half_((int(std::bit_width(n > 1 ? n - 1 : 1)) + 1) / 2) {}

  uint64_t forward(uint64_t i) const {
    do i = rounds(i, 0, 1);
    while (i >= n_);
    return i;
  }
  uint64_t inverse(uint64_t i) const {
    do i = swapped(rounds(swapped(i), kRounds - 1, -1));
    while (i >= n_);
    return i;
  }

 private:
  static constexpr int kRounds = 6;

  uint64_t mask() const { return (uint64_t(1) << half_) - 1; }
  uint64_t swapped(uint64_t i) const { return (i & mask()) << half_ | i >> half_; }
  // (left, right) -> (right, left ^ f(right)); backwards it is the same network on swapped halves.
  uint64_t rounds(uint64_t i, int first, int step) const {
    uint64_t left = i >> half_, right = i & mask();
    for (int round = 0; round < kRounds; ++round) {
      const uint64_t next = left ^ (hash(seed_ + uint64_t(first + step * round), right) & mask());
      left = right;
      right = next;
    }
    return left << half_ | right;
  }

  uint64_t n_;
  uint64_t seed_;
  int half_;
};

}  // namespace svdag::scenes
