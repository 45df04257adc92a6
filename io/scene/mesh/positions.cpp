#include "io/scene/mesh/positions.h"

#include <algorithm>
#include <bit>

#include "streaming/error.h"

namespace svdag {

void Positions::grow() {
  if (spilled()) return hand_over();
  SVDAG_ASSERT(size_ < max_count_);
  const uint64_t chunk = std::bit_ceil(std::min(kChunk, max_count_));
  const uint64_t bytes = reservation_.bytes() + bytes_of(chunk);
  const SpillSpace* space = options_.spill;
  // An eighth of the share is reserved for the blocks being written.
  if (space != nullptr && bytes > space->share - space->share / 8) return spill();
  reservation_.resize(bytes, kPurpose);
  append_chunk(chunk);
  chunk_mask_ = chunk - 1;
}

void Positions::append_chunk(uint64_t count) {
  if (single_) {
    singles_.push_back(std::make_unique_for_overwrite<float[]>(size_t(3 * count)));
  } else {
    doubles_.push_back(std::make_unique_for_overwrite<double[]>(size_t(3 * count)));
  }
}

void Positions::spill() {
  spilled_ = true;
  pages_ = std::make_unique<VertexPages>(*options_.spill, options_.budget, single_);
  for (uint64_t chunk = 0; chunk < size_ / kChunk; ++chunk) {
    hand_over(chunk, kChunk);
    (single_ ? singles_[chunk].reset() : doubles_[chunk].reset());
    reservation_.resize(reservation_.bytes() - bytes_of(kChunk), kPurpose);
  }
  singles_.clear();
  doubles_.clear();
  append_chunk(kOutgoing);
  chunk_mask_ = kOutgoing - 1;
}

void Positions::hand_over(uint64_t chunk, uint64_t count) {
  const auto bytes = single_ ? std::as_bytes(std::span(singles_[chunk].get(), size_t(3 * count)))
                             : std::as_bytes(std::span(doubles_[chunk].get(), size_t(3 * count)));
  windows_ ? windows_->add(bytes) : pages_->add(bytes);
}

void Positions::start_join(bool again) {
  windows_.reset();  // its blocks are used again
  auto windows = std::make_unique<VertexWindows>(*options_.spill, options_.budget, single_);
  pages_->copy_to(windows.get(), again);
  windows_ = std::move(windows);
  if (!again) pages_.reset();
}

}  // namespace svdag
