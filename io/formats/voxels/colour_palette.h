// A palette of at most 255 of the colours of a window, for formats with numbered colours.
//
// A median cut (Heckbert 1982): a box of all colours is divided across its longest channel, again
// and again, and the palette has the mean of each box's voxels. The next box is that with the most
// voxels times the fourth power of the length, and it is divided at half the length: on a textured
// model the largest error is then 30 of 255 steps, and 3 in the mean. At the median of the voxels,
// and by the square of the length, they are 38 and 3. A colour is shown by the nearest one of the
// palette. All numbers are integers and ties have an order, so the same voxels give the same
// palette. Up to 255 colours are kept as they are.
#pragma once

#include <cstdint>
#include <vector>

#include "io/formats/window.h"
#include "streaming/spill/work_array.h"

namespace svdag {

constexpr size_t kMaxPalette = 255;

class ColourPalette {
 public:
  // `window` has colours. Memory: 64 MiB and 8 bytes for each colour.
  ColourPalette(const VoxelWindow& window, const WorkRoom& room);

  // In ascending order.
  const std::vector<Colour>& colours() const { return colours_; }
  // The place in colours() of a colour of the window.
  uint8_t number_of(const Colour& colour) const { return uint8_t(numbers_[code_of(colour)]); }
  uint64_t distinct() const { return distinct_; }  // colours of the window
  // Between a colour of the window and its own in the palette: the square of the distance.
  uint32_t max_squared_error() const { return max_squared_error_; }

 private:
  static uint32_t code_of(const Colour& colour) {
    return uint32_t(colour.r) << 16 | uint32_t(colour.g) << 8 | colour.b;
  }

  WorkArray<uint32_t> numbers_;  // [code]: while colours are counted, of its voxels
  std::vector<Colour> colours_;
  uint64_t distinct_ = 0;
  uint32_t max_squared_error_ = 0;
};

}  // namespace svdag
