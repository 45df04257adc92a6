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
  uint32_t squared_distance(const Colour& other) const {
    const int r = int(channel(0)) - other.r, g = int(channel(1)) - other.g;
    const int b = int(channel(2)) - other.b;
    return uint32_t(r * r + g * g + b * b);
  }
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
  uint64_t weight() const { return voxels * length * length * length * length; }
  // The colours of both halves of the length. There are two colours at least.
  std::array<ColourBox, 2> divided() const {
    const auto channel = [c = longest](const CountedColour& colour) { return colour.channel(c); };
    const auto [low, high] = std::ranges::minmax(colours, {}, channel);
    const uint32_t middle = (channel(low) + channel(high) + 1) / 2;
    const auto upper = std::ranges::stable_partition(
        colours, [&](const CountedColour& colour) { return channel(colour) < middle; });
    return {ColourBox(colours.first(colours.size() - upper.size())), ColourBox(upper)};
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
  for (const ColourBox& box : boxes) colours_.push_back(box.mean());
  std::ranges::sort(colours_);
  colours_.erase(std::ranges::unique(colours_).begin(), colours_.end());
  for (const CountedColour& colour : all) {
    uint32_t least = UINT32_MAX;
    for (uint32_t i = 0; i < colours_.size(); ++i) {
      const uint32_t squared = colour.squared_distance(colours_[i]);
      if (squared < least) least = squared, numbers_[colour.code] = i;
    }
    max_squared_error_ = std::max(max_squared_error_, least);
  }
}

}  // namespace svdag
