// Where the colour of a triangle's points comes from, beyond the one colour of its material: a
// texture, colours of its corners, or both.
//
// colour = texture x factor x colour of the corners, in linear light. The mean of a region is that
// of what is opaque there.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "io/scene/colours/linear_image.h"
#include "io/scene/cutouts/cut_out.h"

namespace svdag {

struct Paint {
  std::shared_ptr<const LinearImage> image;  // null: none
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;                   // texels are squares, seen from near
  std::array<double, 3> factor{1, 1, 1};  // of 0 .. 1

  bool operator==(const Paint&) const = default;
};

using VertexColour = std::array<uint16_t, 3>;       // linear light
using CornerColours = std::array<VertexColour, 3>;  // of a triangle
constexpr CornerColours kWhiteCorners = {{{kWhite16, kWhite16, kWhite16},
                                          {kWhite16, kWhite16, kWhite16},
                                          {kWhite16, kWhite16, kWhite16}}};

// Red, green, blue and weight, 0 .. 65535. Vectors of the compiler: the same operations, so the
// same bits, on every processor.
using ColourSum = float __attribute__((vector_size(16)));

// Samples one level of an image. Coordinates are in texels of the level and below 2^40.
class LevelSampler {
 public:
  LevelSampler() = default;
  // `nearest`: the texel at a point instead of the bilinear mean of four.
  LevelSampler(const Paint& paint, size_t level, bool nearest) noexcept;

  ColourSum at(double u, double v) const noexcept {
    if (nearest_) return texel(column(floor_of(u)), row(floor_of(v)));
    const double x = u - 0.5, y = v - 0.5;
    const int64_t i = floor_of(x), j = floor_of(y);
    const float s = float(x - double(i)), t = float(y - double(j));
    const int64_t i0 = column(i), i1 = column(i + 1), j0 = row(j), j1 = row(j + 1);
    const ColourSum a = texel(i0, j0), b = texel(i1, j0), c = texel(i0, j1), d = texel(i1, j1);
    const ColourSum top = a + (b - a) * s, bottom = c + (d - c) * s;
    return top + (bottom - top) * t;
  }

 private:
  static int64_t floor_of(double x) noexcept {
    const int64_t whole = int64_t(x);
    return whole - (x < double(whole));
  }
  int64_t column(int64_t i) const noexcept {
    return uint64_t(i) < uint64_t(width_) ? i : wrapped(i, width_, wrap_u_);
  }
  int64_t row(int64_t j) const noexcept {
    return uint64_t(j) < uint64_t(height_) ? j : wrapped(j, height_, wrap_v_);
  }
  ColourSum texel(int64_t i, int64_t j) const noexcept {
    const LinearImage::Texel& t = texels_[j * width_ + i];
    return ColourSum{float(t[0]), float(t[1]), float(t[2]), float(t[3])};
  }

  const LinearImage::Texel* texels_ = nullptr;
  int64_t width_ = 0, height_ = 0;
  Wrap wrap_u_ = Wrap::kRepeat, wrap_v_ = Wrap::kRepeat;
  bool nearest_ = false;
};

inline LevelSampler::LevelSampler(const Paint& paint, size_t level, bool nearest) noexcept
    : texels_(paint.image->levels()[level].texels.data()),
      width_(paint.image->levels()[level].width),
      height_(paint.image->levels()[level].height),
      wrap_u_(paint.wrap_u),
      wrap_v_(paint.wrap_v),
      nearest_(nearest) {}

}  // namespace svdag
