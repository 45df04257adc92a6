#include "io/scene/cutouts/alpha_image.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace svdag {

AlphaImage::AlphaImage(int64_t width, int64_t height, std::vector<uint8_t> texels,
                       MemoryBudget::Reservation memory)
    : memory_(std::move(memory)), texels_(std::move(texels)), sizes_({{width, height}}) {
  const auto below = [&](int64_t i, int64_t j) {
    if (sizes_.size() == 1) return AlphaRange{at(i, j), at(i, j)};
    return levels_.back()[size_t(j * sizes_.back()[0] + i)];
  };
  while (sizes_.back() != std::array<int64_t, 2>{1, 1}) {
    const auto [w, h] = sizes_.back();
    const std::array<int64_t, 2> size = {(w + 1) / 2, (h + 1) / 2};
    std::vector<AlphaRange> level(size_t(size[0] * size[1]));
    for (int64_t j = 0; j < h; ++j) {
      for (int64_t i = 0; i < w; ++i) level[size_t(j / 2 * size[0] + i / 2)].add(below(i, j));
    }
    levels_.push_back(std::move(level));
    sizes_.push_back(size);
  }
}

AlphaRange AlphaImage::range(int64_t i0, int64_t i1, int64_t j0, int64_t j1) const {
  constexpr int64_t kFew = 12;  // a block holds more texels than these, whose range is exact
  AlphaRange range;
  if (i1 - i0 < kFew && j1 - j0 < kFew) {
    for (int64_t j = j0; j <= j1; ++j) {
      const uint8_t* const row = &texels_[size_t(j * sizes_[0][0])];
      for (int64_t i = i0; i <= i1; ++i) range.add({row[i], row[i]});
    }
    return range;
  }
  // Of blocks of at least the range's side there are at most two in each direction.
  const int level = int(std::bit_width(uint64_t(std::max(i1 - i0, j1 - j0)) >> 1));
  for (int64_t j = j0 >> level; j <= j1 >> level; ++j) {
    for (int64_t i = i0 >> level; i <= i1 >> level; ++i) {
      range.add(levels_[size_t(level - 1)][size_t(j * sizes_[size_t(level)][0] + i)]);
    }
  }
  return range;
}

}  // namespace svdag
