// A source of one merge: the keys of one level of a run in ascending order, all in memory or block
// by block from a file, whose children a map may rewrite. Maps ascend, so the order stays.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "builder/merge/rank_maps.h"
#include "builder/reduce/run.h"
#include "streaming/error.h"
#include "streaming/spill/spill_block.h"

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

// Whether `key`, rewritten by `map` if one is given, is greater than `bound`.
inline bool after(Brick key, const RankMap*, Brick bound) noexcept {
  return key > bound;
}
inline bool after(const NodeKey& key, const RankMap* map, const NodeKey& bound) noexcept {
  if (map == nullptr) return key > bound;
  for (size_t c = 0; c < key.size(); ++c) {
    const uint32_t child = key[c] == 0 ? 0 : 1 + (*map)[key[c] - 1];
    if (child != bound[c]) return child > bound[c];
  }
  return false;
}

template <class Key>
class LevelSource {
 public:
  explicit LevelSource(std::span<const Key> keys) : window_(keys) {}
  // `count` keys in blocks. `map`, if given, rewrites the children; it must outlive the source.
  LevelSource(std::unique_ptr<BlockSource> blocks, uint64_t count, const RankMap* map = nullptr)
      : left_(count), map_(map), blocks_(std::move(blocks)) {
    load();
  }

  // Number of keys that are in memory: 0 only at the end of the source.
  size_t loaded() const { return window_.size(); }
  // Whether keys are left after the next n.
  bool has_more_than(size_t n) const { return window_.size() > n || left_ != 0; }
  // Loaded key i.
  Key key(size_t i) const {
    Key key = window_[i];
    rewrite_keys({&key, 1});
    return key;
  }
  // Number of the next keys up to `bound`, at most `most`.
  size_t count_up_to(const Key& bound, size_t most) const {
    const auto keys = window_.first(std::min(most, window_.size()));
    return size_t(std::partition_point(keys.begin(), keys.end(),
                                       [&](const Key& key) { return !after(key, map_, bound); }) -
                  keys.begin());
  }
  // Moves the next n keys, which are loaded, to the end of *out, not rewritten yet.
  void take(size_t n, std::vector<Key>* out) {
    out->insert(out->end(), window_.begin(), window_.begin() + ptrdiff_t(n));
    window_ = window_.subspan(n);
    taken_ += n;
    if (window_.empty() && left_ != 0) load();
  }
  // Number of keys taken.
  uint64_t taken() const { return taken_; }
  // Rewrites the children in keys of this source. Thread-safe.
  void rewrite_keys(std::span<Key> keys) const {
    if constexpr (std::is_same_v<Key, NodeKey>) {
      if (map_ != nullptr) rewrite(keys, *map_);
    }
  }

 private:
  void load() {
    const std::span<std::byte> block = blocks_->next();
    window_ = {reinterpret_cast<const Key*>(block.data()), block.size() / sizeof(Key)};
    SVDAG_ASSERT((left_ == 0) == window_.empty() && window_.size() <= left_);
    left_ -= window_.size();
  }

  std::span<const Key> window_;  // keys that are loaded and not taken
  uint64_t left_ = 0;            // number of keys after the window
  uint64_t taken_ = 0;
  const RankMap* map_ = nullptr;
  std::unique_ptr<BlockSource> blocks_;
};

}  // namespace svdag
