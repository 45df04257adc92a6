// Where a material is opaque in all of its texture: a mip map of cells.
//
// A cell is the square between the centres of four texels, in which alpha is bilinear, or a texel
// if the texture is sampled to the nearest. A block of level m has 2^m by 2^m cells. Each has bits
// for "may have an opaque point", "all points are opaque", and "the sample is": the centre of one
// of its texels. A rectangle of cells is looked up in at most 8 x 8 blocks. So its cost does not
// depend on the size of the texture, nor on the texels of the rectangle.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "io/scene/cutouts/alpha_image.h"
#include "io/scene/cutouts/wrap.h"

namespace svdag {

enum class Opacity : uint8_t { kTransparent, kOpaque, kMixed };

// The largest integer that is not greater, for |x| < 2^62.
inline int64_t floor_of(double x) noexcept {
  const int64_t i = int64_t(x);
  return i - (double(i) > x ? 1 : 0);
}

class OpacityMap {
 public:
  static constexpr uint8_t kSome = 1, kAll = 2, kSample = 4;
  static constexpr uint64_t kEach = 0x0101010101010101;  // times a bit: that of eight blocks
  static constexpr int kMaxBlocks = 8;                   // of a side of a rectangle
  // Samples exceed the threshold by so much that rounding in the plain decision does not matter.
  static constexpr double kSurely = 0x1p-10;

  // Of cells, before they are wrapped. Cell i begins at the centre of texel i, or at its edge if
  // sampled to the nearest.
  struct Interval {
    int64_t first, last;
  };
  struct Rectangle {
    Interval u, v;
  };

  // The blocks of a rectangle, which are not wrapped, and how they lie in the texture.
  struct Blocks {
    int columns = 0, rows = 0;
    double size = 0;                 // of a block, in texels
    double u = 0, v = 0;             // the centre of the first block
    double sample = 0;               // from the centre of a block to its sample, in u and v
    uint64_t bits[kMaxBlocks] = {};  // of the rows, a byte a block, the lowest first
  };

  // Points of `threshold` (0 to 255) or more are opaque.
  OpacityMap(const AlphaImage& image, Wrap wrap_u, Wrap wrap_v, bool nearest, double threshold);

  // The cells of all points from `low` to `high` of an axis.
  Interval cells(double low, double high) const noexcept {
    return {floor_of(low - shift_), floor_of(high - shift_)};
  }
  // Of the cell of a point.
  Opacity opacity_at(double u, double v) const noexcept {
    const int64_t i = floor_of(u - shift_), j = floor_of(v - shift_);
    if (i < -1 || i >= u_.size || j < -1 || j >= v_.size) return opacity({{i, i}, {j, j}});
    const uint8_t bits = levels_[0].bits[size_t((j + 1) * levels_[0].pitch + i + 1)];
    return (bits & kAll) != 0    ? Opacity::kOpaque
           : (bits & kSome) != 0 ? Opacity::kMixed
                                 : Opacity::kTransparent;
  }
  // kOpaque or kTransparent: all points of the cells are; kMixed decides nothing.
  Opacity opacity(const Rectangle& cells) const noexcept;
  // As opacity(), with the blocks that decide nothing. None (0 columns) if the rectangle is wrapped
  // in several parts.
  Opacity opacity(const Rectangle& cells, Blocks* blocks) const noexcept;

 private:
  // Columns (or rows) of level 0, of which column 0 holds cell -1.
  struct Axis {
    int64_t size;  // texels
    Wrap wrap;
    int split(Interval cells, bool nearest, Interval out[2]) const noexcept;
    bool has_one_turn(Interval cells, int64_t* start) const noexcept;
  };
  struct Area {  // in blocks of a level, which are not wrapped
    int level, columns, rows;
    int64_t x, y;
    uint64_t bits[kMaxBlocks];
  };
  struct Level {
    int64_t pitch = 0;
    int64_t columns = 0, rows = 0;
    std::vector<uint8_t> bits;  // kMaxBlocks - 1 more than the last row has columns may be read
  };

  int level_of(Interval columns, Interval rows) const noexcept;
  Opacity look_up(Interval columns, Interval rows, Area* area) const noexcept;

  Axis u_, v_;
  bool nearest_;
  double shift_;
  std::vector<Level> levels_;
  std::vector<int64_t> samples_;  // [level]: from the first cell of a block to that of its sample
};

}  // namespace svdag
