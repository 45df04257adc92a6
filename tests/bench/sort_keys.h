// The keys of `make bench-sort`, and the check of a sorter's output.
#pragma once

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace svdag::bench {

using Key = std::array<uint32_t, 8>;  // compared word by word, like nodes

// Makes keys of a kind. "random": every bit is random. "nodes": like the children of nodes: each
// present with probability 0.55, ranks below 2^22 that differ little from those of the last node.
std::vector<Key> make_keys(const std::string& kind, size_t count);

// A hash of a multiset of keys, independent of their order: detects lost, repeated and changed
// keys.
struct Digest {
  uint64_t sum = 0, exclusive = 0, count = 0;

  void add(const Key& key) {
    const auto words = std::bit_cast<std::array<uint64_t, 4>>(key);
    uint64_t mixed = count_less_mix(words);
    sum += mixed;
    exclusive ^= mixed * 0x9e3779b97f4a7c15U;
    ++count;
  }
  bool operator==(const Digest&) const = default;

 private:
  static uint64_t count_less_mix(const std::array<uint64_t, 4>& words) {
    uint64_t mixed = words[0];
    for (size_t i = 1; i < 4; ++i) mixed = std::rotl(mixed * 0xd6e8feb86659fd93U, 32) ^ words[i];
    return std::rotl(mixed * 0xd6e8feb86659fd93U, 32);
  }
};

// Checks a sorter's output, passed key by key.
class SortCheck {
 public:
  void add(const Key& key) {
    ascending_ &= !(key < last_);
    last_ = key;
    digest_.add(key);
  }
  bool matches(const Digest& expected) const { return ascending_ && digest_ == expected; }

 private:
  Key last_{};
  Digest digest_;
  bool ascending_ = true;
};

// The cost of one sort; `written` and `read` are bytes on disk.
struct SortCost {
  double wall = 0, cpu = 0;
  uint64_t written = 0, read = 0;
  bool right = false;  // sorted, with the same keys
};

}  // namespace svdag::bench
