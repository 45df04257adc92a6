#include "io/formats/voxels/colour_palette.h"

#include <algorithm>
#include <array>
#include <span>

namespace svdag {
namespace {

constexpr uint64_t kCodes = uint64_t(1) << 24;

struct CountedColour {
  uint32_t code;  // 0xRRGGBB
  uint32_t voxels;

  uint32_t channel(int c) const { return code >> (16 - 8 * c) & 255; }
};

// A part of the colours, and along which channel it is divided.
struct ColourBox {
  explicit ColourBox(std::span<CountedColour> all) : colours(all) {
    for (const CountedColour& colour : colours) voxels += colour.voxels;
    for (int c = 0; c < 3; ++c) {
      const auto [low, high] = std::ranges::minmax(
          colours, {}, [c](const CountedColour& colour) { return colour.channel(c); });
      const uint32_t side = high.channel(c) - low.channel(c);
      if (side > length) length = side, longest = c;
    }
  }

  // 0 for a single colour.
  uint64_t weight() const { return voxels * length * length; }
  // The colours up to the median, and the others. There are two at least.
  std::array<ColourBox, 2> divided() const {
    std::ranges::sort(colours, {}, [c = longest](const CountedColour& colour) {
      return uint64_t(colour.channel(c)) << 32 | colour.code;
    });
    // Colours with the same value stay together.
    uint64_t before = 0;
    size_t middle = 0;
    for (size_t end = 0; middle == 0 || 2 * before < voxels; middle = end) {
      const uint32_t value = colours[end].channel(longest);
      uint64_t here = before;
      while (end < colours.size() && colours[end].channel(longest) == value)
        here += colours[end++].voxels;
      if (end == colours.size()) break;
      before = here;
    }
    return {ColourBox(colours.first(middle)), ColourBox(colours.subspan(middle))};
  }
  Colour mean() const {
    std::array<uint64_t, 3> sums{};
    for (const CountedColour& colour : colours)
      for (int c = 0; c < 3; ++c) sums[size_t(c)] += uint64_t(colour.channel(c)) * colour.voxels;
    const auto rounded = [&](size_t c) { return uint8_t((2 * sums[c] + voxels) / (2 * voxels)); };
    return {rounded(0), rounded(1), rounded(2)};
  }

  std::span<CountedColour> colours;
  uint64_t voxels = 0;
  uint64_t length = 0;  // of the longest channel
  int longest = 0;
};

}  // namespace

ColourPalette::ColourPalette(const VoxelWindow& window, const WorkRoom& room)
    : numbers_(kCodes, room) {
  for_each_voxel(window.walk, window.box(), [&](const Voxel& voxel) {
    distinct_ += numbers_[code_of(window.colours->of(voxel))]++ == 0;
  });
  const auto counted =
      room.budget->reserve(distinct_ * sizeof(CountedColour), "colours of the palette");
  std::vector<CountedColour> all;
  all.reserve(size_t(distinct_));
  for (uint32_t code = 0; code < kCodes; ++code)
    if (numbers_[code] != 0) all.push_back({code, numbers_[code]});
  std::vector<ColourBox> boxes;
  if (!all.empty()) boxes.emplace_back(all);
  while (!boxes.empty() && boxes.size() < kMaxPalette) {
    const auto next = std::ranges::max_element(boxes, {}, &ColourBox::weight);  // the first of them
    if (next->weight() == 0) break;
    const auto [low, high] = next->divided();
    *next = low;
    boxes.push_back(high);
  }
  // Two boxes may have the same mean: then their colours are next to each other.
  std::ranges::stable_sort(boxes, {}, &ColourBox::mean);
  for (const ColourBox& box : boxes) {
    const Colour mean = box.mean();
    const CountedColour shown{code_of(mean), 0};
    for (const CountedColour& colour : box.colours) {
      numbers_[colour.code] = uint32_t(colours_.size());
      uint32_t squared = 0;
      for (int c = 0; c < 3; ++c) {
        const int error = int(colour.channel(c)) - int(shown.channel(c));
        squared += uint32_t(error * error);
      }
      max_squared_error_ = std::max(max_squared_error_, squared);
    }
    colours_.push_back(mean);
  }
}

}  // namespace svdag
