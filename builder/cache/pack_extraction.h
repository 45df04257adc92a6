// What a bake takes of a pack is a run again: what the taken nodes reach, marked from the top down
// and copied from the bricks up, with ranks for the old ranks. Both orders are the same, so nothing
// is sorted.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "builder/cache/pack_layout.h"
#include "builder/reduce/run.h"
#include "streaming/memory/rank_bitmap.h"

namespace svdag {

class PackExtraction {
 public:
  // Hands the section of a height to its second argument, in order and piece by piece.
  using Read =
      std::function<void(uint32_t height, const std::function<void(std::span<std::byte>)>&)>;

  // Of a proven pack; `header` must outlive this.
  PackExtraction(const PackHeader& header, Read read, MemoryBudget* budget);

  // All that is taken, before the run is made.
  void take(const PackEntry& entry) { marks_[entry.height].set(entry.rank); }
  // For a grid of `levels` levels; spilled if there is a target.
  Run run(int levels, const SpillTarget* target);
  // Of an entry that was taken, in the run.
  uint32_t rank(const PackEntry& entry) const { return marks_[entry.height].rank(entry.rank); }

 private:
  void mark_children(uint32_t height);
  template <class Key>
  void copy(uint32_t height, uint64_t count, int level, const SpillTarget* target,
            RunLevel<Key>* out);
  Brick translated(Brick brick, uint32_t) const { return brick; }
  NodeKey translated(NodeKey key, uint32_t height) const;

  const PackHeader& header_;
  Read read_;
  MemoryBudget* budget_;
  std::vector<RankBitmap> marks_;  // [height]
};

}  // namespace svdag
