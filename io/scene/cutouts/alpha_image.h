// The alpha channel of an image.
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "streaming/memory/memory_budget.h"

namespace svdag {

class AlphaImage {
 public:
  // `texels`: rows from the top, 0 to 255; both sides are at least 1.
  AlphaImage(int64_t width, int64_t height, std::vector<uint8_t> texels,
             MemoryBudget::Reservation memory = {})
      : memory_(std::move(memory)),
        width_(width),
        height_(height),
        texels_(std::move(texels)),
        least_(*std::ranges::min_element(texels_)),
        greatest_(*std::ranges::max_element(texels_)) {}

  int64_t width() const { return width_; }
  int64_t height() const { return height_; }
  const std::vector<uint8_t>& texels() const { return texels_; }
  uint8_t at(int64_t i, int64_t j) const { return texels_[size_t(j * width_ + i)]; }
  uint8_t least() const { return least_; }
  uint8_t greatest() const { return greatest_; }
  // Bytes of an image and of its OpacityMap, which has columns, rows and levels more.
  static uint64_t bytes(int64_t width, int64_t height) {
    const auto cells = uint64_t(width + 8) * uint64_t(height + 2);
    return uint64_t(width) * uint64_t(height) + 2 * cells + 4096;
  }

 private:
  MemoryBudget::Reservation memory_;
  int64_t width_, height_;
  std::vector<uint8_t> texels_;
  uint8_t least_, greatest_;
};

}  // namespace svdag
