// A set of u32 positions with rank queries (Jacobson 1989): maps its positions to 0, 1, 2, ...
//
// Notation: rank(i) = number of positions below i in the set, computed from one count per 64 bits
// and one popcount. Memory is allocated in chunks of 2^16 positions, only for chunks with a
// position in the set, and takes 1.5 bits per position: a few ranges in a wide space are cheap.
// Rejected: a table of u32 per position (20 times the size), a hash table (no order).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "streaming/memory/memory_budget.h"

namespace svdag {

class RankBitmap {
 public:
  // Largest memory, in bytes, of a set of positions below `end`.
  static constexpr uint64_t max_bytes(uint64_t end) {
    return (end + kChunk - 1) / kChunk * sizeof(Chunk);
  }
  // `purpose`: see MemoryBudget::reserve().
  RankBitmap(MemoryBudget* budget, const char* purpose)
      : purpose_(purpose), reservation_(budget->reserve(0, purpose)) {}

  // Adds `i` to the set, before seal(). Error (kMemory) if the budget has no room.
  void set(uint32_t i) {
    const size_t chunk = i / kChunk;
    if (chunk >= chunks_.size() || !chunks_[chunk]) add_chunk(chunk);
    chunks_[chunk]->bits[i % kChunk / 64] |= uint64_t(1) << (i % 64);
  }
  // True if `i` has been added.
  bool has(uint32_t i) const {
    const size_t chunk = i / kChunk;
    return chunk < chunks_.size() && chunks_[chunk] &&
           (chunks_[chunk]->bits[i % kChunk / 64] >> (i % 64) & 1);
  }
  // Ends the construction: no set() afterwards, count() and rank() only afterwards.
  void seal() {
    count_ = 0;
    for (const auto& chunk : chunks_) {
      if (!chunk) continue;
      for (size_t w = 0; w < kWords; ++w) {
        chunk->before[w] = uint32_t(count_);
        count_ += uint64_t(std::popcount(chunk->bits[w]));
      }
    }
  }

  // Number of positions in the set.
  uint64_t count() const { return count_; }
  // Number of positions below `i`, which must be in the set.
  uint32_t rank(uint32_t i) const {
    const Chunk& chunk = *chunks_[i / kChunk];
    const size_t word = i % kChunk / 64;
    return chunk.before[word] +
           uint32_t(std::popcount(chunk.bits[word] & ((uint64_t(1) << (i % 64)) - 1)));
  }
  // The first position of the set from `from` on; nothing if there is none.
  std::optional<uint32_t> next(uint64_t from) const {
    size_t w = from % kChunk / 64;
    uint64_t mask = ~uint64_t(0) << (from % 64);
    for (size_t c = from / kChunk; c < chunks_.size(); ++c) {
      for (; chunks_[c] && w < kWords; ++w) {
        if (const uint64_t bits = chunks_[c]->bits[w] & mask; bits != 0)
          return uint32_t(c * kChunk + w * 64 + size_t(std::countr_zero(bits)));
        mask = ~uint64_t(0);
      }
      w = 0;
      mask = ~uint64_t(0);
    }
    return std::nullopt;
  }
  // Calls visit(position) for all positions, ascending.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (size_t c = 0; c < chunks_.size(); ++c) {
      for (size_t w = 0; chunks_[c] && w < kWords; ++w) {
        for (uint64_t bits = chunks_[c]->bits[w]; bits != 0; bits &= bits - 1)
          visit(uint32_t(c * kChunk + w * 64 + size_t(std::countr_zero(bits))));
      }
    }
  }

 private:
  static constexpr size_t kChunk = size_t(1) << 16, kWords = kChunk / 64;
  struct Chunk {
    std::array<uint64_t, kWords> bits{};
    std::array<uint32_t, kWords> before{};  // number of positions in the set before each word
  };

  void add_chunk(size_t chunk) {
    reservation_.resize(reservation_.bytes() + sizeof(Chunk), purpose_);
    if (chunk >= chunks_.size()) chunks_.resize(chunk + 1);
    chunks_[chunk] = std::make_unique<Chunk>();
  }

  const char* purpose_;
  MemoryBudget::Reservation reservation_;
  std::vector<std::unique_ptr<Chunk>> chunks_;
  uint64_t count_ = 0;
};

}  // namespace svdag
