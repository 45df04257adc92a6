// A set that numbers its members in the order of arrival: the heart of the reduction.
//
// Open addressing over 32-bit numbers, whole keys compared, never hashes. Real node streams in
// depth-first order repeat at once (DESIGN: 90 % of all queries), so a small direct-mapped cache of
// recent keys stands in front of the table. Memory grows with the content and is counted. Rejected:
// std::unordered_map (a node per key, pointer chasing).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "streaming/error.h"
#include "streaming/memory_budget.h"

namespace svdag {

template <class Key, class Hash>
class UniqueSet {
 public:
  static constexpr uint32_t kLimit =
      0xfffffffdU;  // numbers + 1 fit u32, the highest value stays free

  explicit UniqueSet(MemoryBudget* budget) : reservation_(budget->reserve(0, "node tables")) {}

  // The number of `key`, a new one if it was not there.
  uint32_t insert(const Key& key) {
    const uint64_t hash = Hash()(key);
    uint32_t& recent = recent_[hash >> (64 - kRecentBits)];
    if (recent < keys_.size() && keys_[recent] == key) return recent;
    if (keys_.size() * 2 >= slots_.size()) grow();
    size_t slot = hash & (slots_.size() - 1);
    while (slots_[slot] != kFree) {
      if (keys_[slots_[slot]] == key) return recent = slots_[slot];
      slot = (slot + 1) & (slots_.size() - 1);
    }
    if (keys_.size() >= kLimit)
      throw Error(ExitCode::kMemory, "one level needs more than 2^32 nodes: lower the resolution");
    slots_[slot] = recent = uint32_t(keys_.size());
    keys_.push_back(key);
    return recent;
  }

  std::span<const Key> keys() const { return keys_; }
  // Gives the keys away and empties the set.
  std::vector<Key> take() {
    slots_ = {};
    return std::move(keys_);
  }

 private:
  static constexpr int kRecentBits = 12;
  static constexpr uint32_t kFree = 0xffffffffU;

  void grow() {
    const size_t size = slots_.empty() ? 1024 : 2 * slots_.size();
    reservation_.resize(size * sizeof(uint32_t) + size / 2 * sizeof(Key), "node tables");
    keys_.reserve(size / 2);
    slots_.assign(size, kFree);
    for (uint32_t i = 0; i < keys_.size(); ++i) {
      size_t slot = Hash()(keys_[i]) & (size - 1);
      while (slots_[slot] != kFree) slot = (slot + 1) & (size - 1);
      slots_[slot] = i;
    }
  }

  std::vector<Key> keys_;
  std::vector<uint32_t> slots_;
  std::vector<uint32_t> recent_ = std::vector<uint32_t>(size_t(1) << kRecentBits, kFree);
  MemoryBudget::Reservation reservation_;
};

}  // namespace svdag
