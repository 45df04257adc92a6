// A texture as the judge of colours samples it: the finest level only, in doubles.
//
// A sample is a weight and the channels in linear light, times the weight. A texel that its
// material cuts out weighs nothing, others 1; between texels all four values are bilinear. So the
// mean of the weighted samples is that of what is opaque.
#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "io/scene/colours/paint.h"

namespace svdag {

using WeightedColour = std::array<double, 4>;  // weight; red, green, blue times the weight

// Linear light of a value of sRGB of 0 .. 255, and the reverse (IEC 61966-2-1).
double light_of_srgb(double code);
double srgb_of_light(double light);

class JudgedTexture {
 public:
  // `image` with what it keeps of its file. Errors as judged_texels().
  JudgedTexture(const LinearImage& image, bool sandbox);
  // Of texels, as judged_texels() returns them.
  JudgedTexture(int64_t width, int64_t height, std::vector<uint8_t> rgba, double threshold)
      : width_(width), height_(height), rgba_(std::move(rgba)), threshold_(threshold) {}

  // Steps of sRGB by which the builder's decoder may differ. A step of luma or chroma is up to 1.8
  // of blue, and stb_image rounds a part of green down.
  double decoder_error() const { return decoder_error_; }
  // At a point in texels, which is below kMaxTextureCoordinate.
  WeightedColour at(const Paint& paint, double u, double v) const;

 private:
  int64_t width_, height_;
  std::vector<uint8_t> rgba_;
  double threshold_;
  double decoder_error_ = 0;
};

}  // namespace svdag
