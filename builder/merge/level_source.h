// A source of one merge: the keys of one level of a run in ascending order, one at a time, from
// memory or block by block from a file. If a map is given, children are rewritten while reading.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "builder/merge/rank_maps.h"
#include "builder/reduce/run.h"
#include "streaming/spill/block_source.h"

namespace svdag {

// Rewrites run-local children (1 + rank) to global ones (1 + index).
inline void rewrite(std::span<NodeKey> nodes, const RankMap& map) noexcept {
  for (NodeKey& key : nodes) {
    for (uint32_t& child : key) child = child == 0 ? 0 : 1 + map[child - 1];
  }
}

// Like rewrite(), but only for the children in `map`, a window of a rank map. Later windows must
// hold lower ranks.
inline void rewrite_window(std::span<NodeKey> nodes, const RankMap& map) noexcept {
  for (NodeKey& key : nodes) {
    for (uint32_t& child : key) {
      if (child != 0 && map.holds(child - 1)) child = 1 + map[child - 1];
    }
  }
}

template <class Key>
class LevelSource {
 public:
  explicit LevelSource(std::span<const Key> keys)
      : at_(keys.data()), end_(keys.data() + keys.size()) {
    update_prefix();
  }
  // `map`, if given, rewrites the children; it must outlive the source.
  explicit LevelSource(std::unique_ptr<BlockSource> blocks, const RankMap* map = nullptr)
      : map_(map), blocks_(std::move(blocks)) {
    refill();
  }

  bool ended() const { return at_ == end_; }
  const Key& head() const { return *at_; }
  void advance() {
    if (++at_ == end_ && blocks_) return refill();
    update_prefix();
  }
  // The first 64 bits of the head decide most comparisons; UINT64_MAX at the end.
  uint64_t prefix() const { return prefix_; }
  // Whether the head is less than that of `other`, which has the same prefix. An ended source is
  // last.
  bool before(const LevelSource& other) const {
    if (ended() || other.ended()) return !ended();
    return *at_ < *other.at_;
  }

 private:
  static uint64_t prefix_of(Brick brick) { return brick; }
  static uint64_t prefix_of(const NodeKey& key) { return uint64_t(key[0]) << 32 | key[1]; }
  void update_prefix() { prefix_ = ended() ? UINT64_MAX : prefix_of(*at_); }

  void refill() {
    const std::span<std::byte> block = blocks_->next();
    const std::span<Key> keys(reinterpret_cast<Key*>(block.data()), block.size() / sizeof(Key));
    if constexpr (std::is_same_v<Key, NodeKey>) {
      if (map_ != nullptr) rewrite(keys, *map_);
    }
    at_ = keys.data();
    end_ = at_ + keys.size();
    update_prefix();
  }

  const Key* at_ = nullptr;
  const Key* end_ = nullptr;
  uint64_t prefix_ = 0;
  const RankMap* map_ = nullptr;
  std::unique_ptr<BlockSource> blocks_;
};

}  // namespace svdag
