#include "io/scene/colours/linear_image.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/colour.h"

namespace svdag {
namespace {

// Texels first .. of a row or column, with their shares of a coarser texel.
struct Covered {
  int64_t first = 0;
  int count = 0;
  std::array<uint64_t, 3> share{};  // sum: the length of the finer row
};

// Of coarser texel i: it covers [i fine, (i + 1) fine), finer texel j [j coarse, (j + 1) coarse).
Covered covered_by(int64_t i, int64_t coarse, int64_t fine) {
  Covered covered;
  covered.first = i * fine / coarse;
  for (int64_t j = covered.first; j * coarse < (i + 1) * fine; ++j) {
    const int64_t begin = std::max(j * coarse, i * fine);
    const int64_t end = std::min((j + 1) * coarse, (i + 1) * fine);
    covered.share[size_t(covered.count++)] = uint64_t(end - begin);
  }
  return covered;
}

LinearImage::Level coarser(const LinearImage::Level& fine) {
  LinearImage::Level level{
      std::max<int64_t>(1, fine.width / 2), std::max<int64_t>(1, fine.height / 2), {}};
  level.texels.resize(size_t(level.width * level.height));
  std::vector<Covered> columns;
  for (int64_t i = 0; i < level.width; ++i)
    columns.push_back(covered_by(i, level.width, fine.width));
  const uint64_t whole = uint64_t(fine.width) * uint64_t(fine.height);
  auto out = level.texels.begin();
  for (int64_t j = 0; j < level.height; ++j) {
    const Covered row = covered_by(j, level.height, fine.height);
    for (const Covered& column : columns) {
      std::array<uint64_t, 4> sum;
      sum.fill(whole / 2);
      for (int y = 0; y < row.count; ++y) {
        for (int x = 0; x < column.count; ++x) {
          const uint64_t share = row.share[size_t(y)] * column.share[size_t(x)];
          const LinearImage::Texel& texel = fine.at(column.first + x, row.first + y);
          for (size_t c = 0; c < 4; ++c) sum[c] += share * texel[c];
        }
      }
      for (size_t c = 0; c < 4; ++c) (*out)[c] = uint16_t(sum[c] / whole);
      ++out;
    }
  }
  return level;
}

}  // namespace

uint16_t light16(double light) noexcept {
  return light > 0 ? uint16_t(std::min(light, 1.0) * kWhite16 + 0.5) : uint16_t(0);
}

uint16_t light16_of_srgb(double value) noexcept {
  return value > 0 ? light16(light_of(255 * std::min(value, 1.0))) : uint16_t(0);
}

LinearImage::LinearImage(int64_t width, int64_t height, const std::vector<uint8_t>& rgba,
                         double threshold, MemoryBudget::Reservation memory)
    : memory_(std::move(memory)) {
  Level& finest = levels_.emplace_back(Level{width, height, {}});
  finest.texels.reserve(size_t(width * height));
  for (size_t i = 0; i < size_t(width * height); ++i) {
    const uint8_t* const texel = &rgba[4 * i];
    if (double(texel[3]) < threshold) {
      finest.texels.push_back({});
      has_holes_ = true;
    } else {
      finest.texels.push_back({light16_of_code(texel[0]), light16_of_code(texel[1]),
                               light16_of_code(texel[2]), kWhite16});
    }
  }
  add_coarser_levels();
}

LinearImage::LinearImage(Level finest, MemoryBudget::Reservation memory)
    : memory_(std::move(memory)),
      has_holes_(std::ranges::any_of(finest.texels,
                                     [](const Texel& texel) { return texel[3] < kWhite16; })) {
  levels_.push_back(std::move(finest));
  add_coarser_levels();
}

void LinearImage::add_coarser_levels() {
  while (levels_.back().width > 1 || levels_.back().height > 1)
    levels_.push_back(coarser(levels_.back()));
}

}  // namespace svdag
