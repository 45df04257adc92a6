// The alpha channel of an image, with the least and the largest alpha of its blocks: texels of
// level 0, of which four make one of the next level (a mip map of minima and maxima).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "streaming/memory/memory_budget.h"

namespace svdag {

struct AlphaRange {
  uint8_t least = 255, largest = 0;

  void add(const AlphaRange& other) {
    least = other.least < least ? other.least : least;
    largest = other.largest > largest ? other.largest : largest;
  }
};

class AlphaImage {
 public:
  // `texels`: rows from the top, 0 to 255; both sides are at least 1.
  AlphaImage(int64_t width, int64_t height, std::vector<uint8_t> texels,
             MemoryBudget::Reservation memory = {});

  int64_t width() const { return sizes_[0][0]; }
  int64_t height() const { return sizes_[0][1]; }
  const std::vector<uint8_t>& texels() const { return texels_; }
  uint8_t at(int64_t i, int64_t j) const { return texels_[size_t(j * sizes_[0][0] + i)]; }
  // A range that holds the alpha of the texels i0 to i1 of the rows j0 to j1; exact if they are
  // few.
  AlphaRange range(int64_t i0, int64_t i1, int64_t j0, int64_t j1) const;
  // Most bytes of an image of so many texels: levels have two bytes a block, and in one row half as
  // many blocks as the level before.
  static uint64_t bytes(uint64_t texels) { return 3 * texels + 128; }

 private:
  MemoryBudget::Reservation memory_;
  std::vector<uint8_t> texels_;
  std::vector<std::vector<AlphaRange>> levels_;  // [level - 1]
  std::vector<std::array<int64_t, 2>> sizes_;    // [level]: width and height
};

}  // namespace svdag
