#include "streaming/file/block_filler.h"

#include <algorithm>
#include <cstring>

namespace svdag {

BlockFiller::BlockFiller(size_t size, size_t margin)
    : size_(size),
      margin_(margin),
      block_(std::make_unique_for_overwrite<std::byte[]>(size)),
      filled_(margin) {}

void BlockFiller::append(std::span<const std::byte> bytes, FilledBlocks* filled) {
  position_ += bytes.size();
  while (!bytes.empty()) {
    const size_t n = std::min(bytes.size(), size_ - filled_);
    std::memcpy(block_.get() + filled_, bytes.data(), n);
    filled_ += n;
    bytes = bytes.subspan(n);
    if (filled_ == size_) hand_out(filled);
  }
}

void BlockFiller::finish(FilledBlocks* filled) {
  if (filled_ > margin_) hand_out(filled);
}

void BlockFiller::hand_out(FilledBlocks* filled) {
  const uint64_t number = checksums_.size();
  checksums_.push_back(0);
  filled->blocks.push_back({number, std::move(block_), filled_, &checksums_.back()});
  filled_ = margin_;
  if (filled->spare.empty()) {
    block_ = std::make_unique_for_overwrite<std::byte[]>(size_);
  } else {
    block_ = std::move(filled->spare.back());
    filled->spare.pop_back();
  }
}

}  // namespace svdag
