// The corners of a polygon that may be ears: not tested since the ring last changed around them.
//
// A corner that is not an ear because another one is in its triangle waits until that one is
// removed. Nothing else can make it an ear, so the result is the same as if all were tested.
// Rejected: testing every corner after each ear, which is quadratic where ears are rare.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace svdag {

// A set of numbers 0 ... n-1; finds the next element from any number on in a few steps.
class NumberSet {
 public:
  // All of them.
  void fill(uint32_t n) {
    depth_ = 0;
    for (uint64_t bits = n; depth_ == 0 || bits > 1; bits = (bits + 63) / 64) {
      auto& words = levels_[depth_++];
      words.assign((bits + 63) / 64, ~uint64_t(0));
      if (bits % 64 != 0) words.back() = (uint64_t(1) << bits % 64) - 1;
    }
  }
  void insert(uint32_t i) {
    for (size_t level = 0; level < depth_; ++level, i /= 64)
      levels_[level][i / 64] |= uint64_t(1) << i % 64;
  }
  void erase(uint32_t i) {
    for (size_t level = 0; level < depth_; ++level, i /= 64) {
      if ((levels_[level][i / 64] &= ~(uint64_t(1) << i % 64)) != 0) return;
    }
  }
  // The first element >= `from`, or UINT32_MAX.
  uint32_t next(uint32_t from) const {
    uint64_t i = from;
    for (size_t level = 0; level < depth_; ++level) {
      const auto& words = levels_[level];
      if (i / 64 >= words.size()) return UINT32_MAX;
      if (const uint64_t rest = words[i / 64] >> i % 64; rest != 0) {
        i += uint64_t(std::countr_zero(rest));
        while (level > 0) i = i * 64 + uint64_t(std::countr_zero(levels_[--level][i]));
        return uint32_t(i);
      }
      i = i / 64 + 1;
    }
    return UINT32_MAX;
  }

 private:
  size_t depth_ = 0;
  std::array<std::vector<uint64_t>, 6> levels_;  // a bit for each number, then each word below
};

class EarCandidates {
 public:
  static constexpr size_t kBytesPerCorner = 4 * sizeof(uint32_t) + 1;

  void reset(uint32_t n) {
    n_ = n;
    set_.fill(n);
    links_.resize(size_t(2) * n);
    for (size_t i = 0; i < links_.size(); ++i) links_[i] = {uint32_t(i), uint32_t(i)};
  }
  uint32_t next(uint32_t from) const { return set_.next(from); }

  // The corner may be an ear.
  void insert(uint32_t corner) {
    unlink(corner);
    set_.insert(corner);
  }
  // It is not an ear, independent of the other corners; tested again only after insert().
  void erase(uint32_t corner) {
    unlink(corner);
    set_.erase(corner);
  }
  // It is not an ear because of `other`.
  void wait(uint32_t corner, uint32_t other) {
    erase(corner);
    const uint32_t head = n_ + other, first = links_[head].next;
    links_[corner] = {first, head};
    links_[head].next = links_[first].prev = corner;
  }
  // Inserts those that wait for `other` and for which ask(corner) is true.
  template <class Ask>
  void wake(uint32_t other, const Ask& ask) {
    for (uint32_t i = links_[n_ + other].next, after; i != n_ + other; i = after) {
      after = links_[i].next;
      if (ask(i)) insert(i);
    }
  }

 private:
  struct Link {
    uint32_t next, prev;
  };
  void unlink(uint32_t corner) {
    const Link link = links_[corner];
    links_[link.prev].next = link.next;
    links_[link.next].prev = link.prev;
    links_[corner] = {corner, corner};
  }

  uint32_t n_ = 0;
  NumberSet set_;
  std::vector<Link> links_;  // rings: n + i begins that of the corners that wait for i
};

}  // namespace svdag
