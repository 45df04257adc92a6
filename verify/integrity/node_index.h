// Numbers the nodes of one section of a DAG, to store values per node instead of per word.
//
// Consists of a bitmap of the words that begin a node and the count of nodes before each 64 words.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace svdag {

class NodeIndex {
 public:
  NodeIndex() = default;
  NodeIndex(const uint32_t* words, uint64_t count) : starts_((count + 63) / 64) {
    for (uint64_t w = 0; w < count; w += 1 + uint64_t(std::popcount(words[w] & 0xffU))) {
      starts_[w / 64] |= uint64_t(1) << (w % 64);
      ++nodes_;
    }
    before_.reserve(starts_.size());
    uint32_t sum = 0;
    for (const uint64_t bits : starts_) {
      before_.push_back(sum);
      sum += uint32_t(std::popcount(bits));
    }
  }

  uint64_t nodes() const { return nodes_; }
  bool is_start(uint64_t word) const {
    return word / 64 < starts_.size() && (starts_[word / 64] >> (word % 64) & 1U) != 0;
  }
  // The number of nodes that begin before `word`: the index of a node that begins there.
  uint64_t rank(uint64_t word) const {
    const uint64_t below = starts_[word / 64] & ((uint64_t(1) << (word % 64)) - 1);
    return before_[word / 64] + uint64_t(std::popcount(below));
  }

 private:
  std::vector<uint64_t> starts_;
  std::vector<uint32_t> before_;
  uint64_t nodes_ = 0;
};

}  // namespace svdag
