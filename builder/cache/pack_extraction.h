// Extracts the cells that a bake takes from a pack as a run.
//
// The nodes that the taken ones reach are marked from the top down, then copied from the bricks up,
// with new ranks. Old and new ranks have the same order, so nothing is sorted.
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
  // Passes the section of a height to the second argument, in order and in chunks.
  using Read =
      std::function<void(uint32_t height, const std::function<void(std::span<std::byte>)>&)>;

  // The pack must be proven; `header` must outlive this object.
  PackExtraction(const PackHeader& header, Read read, MemoryBudget* budget);

  // Takes an entry; all must be taken before run().
  void take(const PackEntry& entry) { marks_[entry.height].set(entry.rank); }
  // The run of a grid with `levels` levels; spilled if `target` is given.
  Run run(int levels, const SpillTarget* target);
  // The rank in the run of a taken entry. After run().
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
