// A palette of at most 255 of the colours of a window, for formats with numbered colours.
//
// Median cut (Heckbert 1982): one box of all colours is divided, at the median of its voxels along
// its longest channel, again and again. The next box is the one with the most voxels times the
// square of that length, so that a colour of many voxels and an odd one both find theirs. A box
// shows the mean of its voxels. All numbers are integers and ties have an order, so the same voxels
// give the same palette; and up to 255 colours are kept as they are.
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
