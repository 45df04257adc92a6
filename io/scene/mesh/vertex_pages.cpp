#include "io/scene/mesh/vertex_pages.h"

#include <algorithm>

#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

// The page that is being filled, the one before that is being written, and one that is read ahead.
constexpr uint64_t kOtherBlocks = 3;

}  // namespace

VertexPages::VertexPages(const SpillSpace& space, MemoryBudget* budget, bool single)
    : file_(open_spill(space)),
      new_number_(space.stream_number),
      budget_(budget),
      single_(single),
      position_bytes_(3 * (single ? sizeof(float) : sizeof(double))),
      page_size_(file_->payload_bytes() / position_bytes_),
      reciprocal_(UINT64_MAX / page_size_ + 1),
      max_frames_(size_t(space.share / file_->block_bytes() - kOtherBlocks)),
      last_(budget, file_->block_bytes()) {}

void VertexPages::add(std::span<const std::byte> positions) {
  check_interrupt();
  while (!positions.empty()) {
    const size_t page_bytes = page_size_ * position_bytes_;
    const size_t n = std::min(page_bytes - last_filled_, positions.size());
    std::ranges::copy(positions.first(n), last_.bytes().begin() + ptrdiff_t(last_filled_));
    positions = positions.subspan(n);
    last_filled_ += n;
    size_ += n / position_bytes_;
    if (last_filled_ == page_bytes) write_page();
  }
}

void VertexPages::write_page() {
  SpillWriter writer(file_, new_number_(), budget_);
  writer.append(last_.bytes().first(last_filled_));
  last_filled_ = 0;
  pages_.emplace_back(file_, writer.finish());
  loaded_.push_back(nullptr);
  being_written_.reset();  // waits for the page before
  being_written_.emplace(std::move(writer));
}

const std::byte* VertexPages::load(uint64_t page) {
  check_interrupt();
  ++reads_;
  if (!fetch_ || requested_ != page) request(page);
  const std::byte* const bytes = fetch_->wait().data();
  frames_.push_back({page, fetch_->take_block()});
  fetch_.reset();
  loaded_[page] = bytes;
  const uint64_t next = page + 1;
  if (page == last_read_ + 1 && next < pages_.size() && loaded_[next] == nullptr) request(next);
  last_read_ = page;
  return bytes;
}

void VertexPages::request(uint64_t page) {
  being_written_.reset();
  fetch_.reset();
  fetch_.emplace(file_, pages_[page].stream(), 0, free_block());
  requested_ = page;
}

SpillBlock VertexPages::free_block() {
  if (frames_.size() < max_frames_) return SpillBlock(budget_, file_->block_bytes());
  Frame oldest = std::move(frames_.front());
  frames_.pop_front();
  loaded_[oldest.page] = nullptr;
  return std::move(oldest.block);
}

void VertexPages::unload() {
  being_written_.reset();
  fetch_.reset();
  frames_.clear();
  std::ranges::fill(loaded_, nullptr);
}

void VertexPages::copy_to(VertexWindows* windows, bool keep) {
  for_each_page(keep, [&](std::span<const std::byte> bytes) { windows->add(bytes); });
}

}  // namespace svdag
