// The vertex positions of one mesh: the only thing that a reader holds in memory.
//
// They grow in chunks, each reserved in the budget before it is allocated, so a header cannot
// request more memory than the file has vertices, and growing never copies. The first chunk is no
// larger than the reader's upper bound: small meshes take little. Positions that the file
// stores as float are kept as float: half the memory, the same values. Positions beyond the share
// that a SpillSpace grants move to pages in a spill file, all of them, where corners still look
// theirs up; if that becomes costly, to windows for a join (io/scene/polygons/mesh_writer.h).
// Rejected: std::vector (twice the memory while it grows, or trust in the header's count).
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "io/scene/mesh/mesh_reader.h"
#include "io/scene/mesh/vertex_pages.h"
#include "io/scene/mesh/vertex_windows.h"
#include "io/triangle.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

class Positions {
 public:
  enum class Precision { kSingle, kDouble };

  // More than `max_count` positions are a defect of the reader.
  Positions(const ReadOptions& options, Precision precision, uint64_t max_count)
      : single_(precision == Precision::kSingle),
        options_(options),
        max_count_(max_count),
        reservation_(options.budget->reserve(0, kPurpose)) {}

  uint64_t size() const { return size_; }
  // Reserved for positions in memory.
  uint64_t bytes() const { return reservation_.bytes(); }

  void add(const Point& p) {
    if ((size_ & chunk_mask_) == 0) grow();
    if (single_) {
      store(singles_.back().get(), p);
    } else {
      store(doubles_.back().get(), p);
    }
    ++size_;
  }

  // `i` < size(), and all positions are in memory.
  Point operator[](uint64_t i) const {
    return single_ ? fetch(singles_[i / kChunk].get(), i) : fetch(doubles_[i / kChunk].get(), i);
  }

  // Whether the positions have left memory.
  bool spilled() const { return spilled_; }
  // Spilled: whether they can be looked up.
  bool paged() const { return spilled_ && !windows_; }
  VertexPages& pages() { return *pages_; }
  // Paged, `i` < size().
  Point look_up(uint64_t i) {
    const uint64_t handed_over = pages_->size();
    if (i < handed_over) return (*pages_)[i];
    return single_ ? fetch(singles_[0].get(), i - handed_over)
                   : fetch(doubles_[0].get(), i - handed_over);
  }
  // Paged: moves the positions so far to windows; those to come follow. They stay in their pages,
  // too, if this will be called again.
  void start_join(bool again);
  VertexWindows& windows() { return *windows_; }
  // Spilled, and all were added: all positions are in the pages or windows.
  void hand_over() { hand_over(0, size_ - (windows_ ? windows_->size() : pages_->size())); }

 private:
  static constexpr uint64_t kChunk = 1 << 15;
  static constexpr uint64_t kOutgoing = 1 << 9;  // positions passed to the pages at once
  static constexpr const char* kPurpose = "vertex positions";

  void grow();
  void spill();
  void hand_over(uint64_t chunk, uint64_t count);
  uint64_t bytes_of(uint64_t count) const {
    return count * 3 * (single_ ? sizeof(float) : sizeof(double));
  }
  void append_chunk(uint64_t count);
  template <class T>
  void store(T* chunk, const Point& p) {
    T* out = chunk + 3 * (size_ & chunk_mask_);
    for (int a = 0; a < 3; ++a) out[a] = static_cast<T>(p[a]);
  }
  template <class T>
  static Point fetch(const T* chunk, uint64_t i) {
    const T* in = chunk + 3 * (i % kChunk);
    return {double(in[0]), double(in[1]), double(in[2])};
  }

  bool single_;
  const ReadOptions& options_;
  uint64_t max_count_;
  uint64_t size_ = 0;
  uint64_t chunk_mask_ = 0;  // of the chunk that is filled: its size less one
  MemoryBudget::Reservation reservation_;
  std::vector<std::unique_ptr<float[]>> singles_;
  std::vector<std::unique_ptr<double[]>> doubles_;
  bool spilled_ = false;  // the only chunk holds the positions not yet passed on
  std::unique_ptr<VertexPages> pages_;
  std::unique_ptr<VertexWindows> windows_;
};

}  // namespace svdag
