#include "builder/cache/pack_extraction.h"

#include <optional>

#include "streaming/error.h"
#include "streaming/spill/spill_file.h"

namespace svdag {
namespace {

// Collects the keys of one level of a run, in memory or in a stream.
template <class Key>
class LevelWriter {
 public:
  LevelWriter(RunLevel<Key>* level, uint64_t count, int number, MemoryBudget* budget,
              const SpillTarget* target)
      : level_(level) {
    if (target != nullptr) {
      writer_.emplace(target->file, target->first_stream + uint64_t(number), budget);
    } else {
      level->reservation = budget->reserve(count * sizeof(Key), "cells of the cache");
      level->keys.reserve(count);
    }
  }
  void add(const Key& key) {
    if (writer_) {
      writer_->append(std::as_bytes(std::span(&key, 1)));
    } else {
      level_->keys.push_back(key);
    }
  }
  void finish() {
    if (writer_) level_->spilled = writer_->finish();
  }

 private:
  RunLevel<Key>* level_;
  std::optional<SpillWriter> writer_;
};

}  // namespace

PackExtraction::PackExtraction(const PackHeader& header, Read read, MemoryBudget* budget)
    : header_(header), read_(std::move(read)), budget_(budget) {
  for (uint32_t h = 0; h < PackHeader::kHeights; ++h)
    marks_.emplace_back(budget, "marks of a pack");
}

Run PackExtraction::run(int levels, const SpillTarget* target) {
  for (uint32_t h = PackHeader::kHeights - 1; h > kBrickHeight; --h) mark_children(h);
  std::vector<uint64_t> counts;
  for (RankBitmap& marks : marks_) {
    marks.seal();
    counts.push_back(marks.count());
  }
  Run run;
  run.nodes.resize(size_t(levels - 2));
  copy(kBrickHeight, counts[kBrickHeight], levels - 2, target, &run.bricks);
  for (int level = levels - 3; level >= 0; --level) {
    const uint32_t h = uint32_t(levels - level);
    copy(h, counts[h], level, target, &run.nodes[size_t(level)]);
  }
  return run;
}

void PackExtraction::mark_children(uint32_t height) {
  uint32_t rank = 0;
  read_(height, [&](std::span<std::byte> bytes) {
    for (const NodeKey& key : keys_in<NodeKey>(bytes)) {
      if (!marks_[height].has(rank++)) continue;
      for (const uint32_t child : key) {
        SVDAG_ASSERT(child <= header_.keys[height - 1]);  // prove() checked it
        if (child != 0) marks_[height - 1].set(child - 1);
      }
    }
  });
}

template <class Key>
void PackExtraction::copy(uint32_t height, uint64_t count, int level, const SpillTarget* target,
                          RunLevel<Key>* out) {
  LevelWriter<Key> writer(out, count, level, budget_, target);
  uint32_t rank = 0;
  if (count > 0) {
    read_(height, [&](std::span<std::byte> bytes) {
      for (const Key& key : keys_in<Key>(bytes)) {
        if (marks_[height].has(rank++)) writer.add(translated(key, height));
      }
    });
  }
  writer.finish();
}

NodeKey PackExtraction::translated(NodeKey key, uint32_t height) const {
  for (uint32_t& child : key) child = child == 0 ? 0 : 1 + marks_[height - 1].rank(child - 1);
  return key;
}

}  // namespace svdag
