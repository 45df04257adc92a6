// A source of one merge: the keys of one level of a run in ascending order, all in memory or block
// by block from a file. If a map is given, children are rewritten while reading.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "builder/merge/rank_maps.h"
#include "builder/reduce/run.h"
#include "streaming/error.h"
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
  explicit LevelSource(std::span<const Key> keys) : window_(keys.first(0)), left_(keys.size()) {}
  // `count` keys in blocks. `map`, if given, rewrites the children; it must outlive the source.
  LevelSource(std::unique_ptr<BlockSource> blocks, uint64_t count, const RankMap* map = nullptr)
      : left_(count), map_(map), blocks_(std::move(blocks)) {}

  // The next keys.
  std::span<const Key> window() const { return window_; }
  // Whether keys are left after the window.
  bool has_more() const { return left_ != 0; }
  // Whether refill() reads and copies.
  bool reads() const { return blocks_ != nullptr; }
  // Removes the first n keys of the window.
  void consume(size_t n) { window_ = window_.subspan(n); }
  // Extends the window to at least `size` keys, or all that are left; from blocks, by less than a
  // block more.
  void refill(size_t size) {
    if (window_.size() >= size || left_ == 0) return;
    if (blocks_ == nullptr) {
      const size_t added = std::min<uint64_t>(size - window_.size(), left_);
      window_ = {window_.data(), window_.size() + added};
      left_ -= added;
      return;
    }
    std::copy(window_.begin(), window_.end(), buffer_.begin());
    buffer_.resize(window_.size());
    while (buffer_.size() < size && left_ != 0) {
      const std::span<std::byte> block = blocks_->next();
      const std::span<Key> keys(reinterpret_cast<Key*>(block.data()), block.size() / sizeof(Key));
      if constexpr (std::is_same_v<Key, NodeKey>) {
        if (map_ != nullptr) rewrite(keys, *map_);
      }
      SVDAG_ASSERT(!keys.empty() && keys.size() <= left_);
      buffer_.insert(buffer_.end(), keys.begin(), keys.end());
      left_ -= keys.size();
    }
    window_ = buffer_;
  }

 private:
  std::span<const Key> window_;
  uint64_t left_ = 0;  // number of keys after the window
  const RankMap* map_ = nullptr;
  std::unique_ptr<BlockSource> blocks_;
  std::vector<Key> buffer_;  // holds the window, if keys come from blocks
};

}  // namespace svdag
