// A set of ranks, and how many of its members stand before one.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

#include "streaming/memory_budget.h"

namespace svdag {

class RankBits {
 public:
  RankBits(uint64_t ranks, MemoryBudget* budget)
      : counted_(budget->reserve((ranks / 64 + 1) * 12, "marks of a pack")),
        words_(ranks / 64 + 1),
        before_(ranks / 64 + 1) {}

  void set(uint64_t rank) { words_[rank / 64] |= uint64_t(1) << rank % 64; }
  bool has(uint64_t rank) const { return words_[rank / 64] >> rank % 64 & 1; }
  // No more is set. Returns the number of members.
  uint64_t count() {
    uint64_t sum = 0;
    for (size_t w = 0; w < words_.size(); ++w) {
      before_[w] = uint32_t(sum);
      sum += uint64_t(std::popcount(words_[w]));
    }
    return sum;
  }
  // After count(): members before `rank`.
  uint32_t before(uint64_t rank) const {
    const uint64_t below = words_[rank / 64] & ((uint64_t(1) << rank % 64) - 1);
    return before_[rank / 64] + uint32_t(std::popcount(below));
  }

 private:
  MemoryBudget::Reservation counted_;
  std::vector<uint64_t> words_;
  std::vector<uint32_t> before_;
};

}  // namespace svdag
