// The box of the vertices that triangles use, without a join: a bit per vertex, then one pass over
// the positions.
//
// Returns a box only if it certainly equals the box of the triangles. Otherwise the join is needed:
// the marks do not fit in memory, a coordinate is NaN or infinite, or zeros of both signs are on
// one face of the box (the triangles' order decides which of them is kept).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "io/scene/mesh/vertex_pages.h"

namespace svdag {

class VertexMarks {
 public:
  VertexMarks(MemoryBudget* budget, uint64_t max_bytes)
      : max_bytes_(max_bytes), memory_(budget->reserve(0, kPurpose)) {}

  void mark(uint64_t i) {
    const size_t chunk = size_t(i / kChunk);
    if (chunk >= chunks_.size() || !chunks_[chunk]) {
      if (!make(chunk)) return;
    }
    chunks_[chunk][i % kChunk / 64] |= uint64_t(1) << i % 64;
  }
  bool marked(uint64_t i) const {
    const size_t chunk = size_t(i / kChunk);
    return chunk < chunks_.size() && chunks_[chunk] &&
           (chunks_[chunk][i % kChunk / 64] >> i % 64 & 1) != 0;
  }
  // Nothing if the marks do not determine the box.
  std::optional<Box> box(VertexPages* positions) const;

 private:
  static constexpr uint64_t kChunk = 1 << 13;  // vertices: 1 KiB
  static constexpr const char* kPurpose = "marks of vertices";

  bool make(size_t chunk);

  uint64_t max_bytes_;
  bool full_ = false;
  MemoryBudget::Reservation memory_;
  std::vector<std::unique_ptr<uint64_t[]>> chunks_;
};

}  // namespace svdag
