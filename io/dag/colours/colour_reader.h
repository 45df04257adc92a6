// The decoded colours of a file, read by ascending numbers: each chunk is decoded once.
#pragma once

#include <algorithm>
#include <vector>

#include "io/dag/colours/chunk_codec.h"
#include "io/dag/colours/colour_view.h"

namespace svdag {

class ColourReader {
 public:
  ColourReader(const ColourView& view, uint64_t count) : view_(view), count_(count) {}

  // Skipped entries cost a binary search.
  void advance(uint64_t number) {
    if (number < entry_end()) return;
    const ColourEntry *const begin = view_.entries + entry_ + 1, *const end = view_.entries +
                                                                              view_.entry_count;
    const auto is_before = [](uint64_t n, const ColourEntry& entry) { return n < entry.first; };
    entry_ = uint64_t(std::upper_bound(begin, end, number, is_before) - view_.entries) - 1;
  }
  // Of the entry of the current number.
  const ColourEntry& entry() const { return view_.entries[entry_]; }
  uint64_t entry_end() const {
    return entry_ + 1 < view_.entry_count ? view_.entries[entry_ + 1].first : count_;
  }
  bool is_chunk() const { return (entry().value & kChunkEntry) != 0; }
  uint32_t colour(uint64_t number) {
    if (!is_chunk()) return uint32_t(entry().value);
    if (chunk_.empty() || decoded_ != entry_) {
      chunk_.resize(size_t(entry_end() - entry().first));
      decode_chunk(view_.chunks + (entry().value & ~kChunkEntry), chunk_);
      decoded_ = entry_;
    }
    return chunk_[size_t(number - entry().first)];
  }

 private:
  const ColourView& view_;
  const uint64_t count_;
  uint64_t entry_ = 0, decoded_ = 0;
  std::vector<uint32_t> chunk_;  // of entry decoded_
};

}  // namespace svdag
