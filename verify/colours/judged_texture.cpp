#include "verify/colours/judged_texture.h"

#include <cmath>

#include "verify/colours/image_decoders.h"

namespace svdag {
namespace {

// The texel of a row of n that texel i of the endless row is.
int64_t inside(int64_t i, int64_t n, Wrap wrap) {
  if (wrap == Wrap::kClamp) return i < 0 ? 0 : i >= n ? n - 1 : i;
  const int64_t period = wrap == Wrap::kMirror ? 2 * n : n;
  const int64_t at = (i % period + period) % period;
  return at < n ? at : period - 1 - at;
}

}  // namespace

double light_of_srgb(double code) {
  const double value = code / 255;
  return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

double srgb_of_light(double light) {
  return 255 * (light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}

JudgedTexture::JudgedTexture(const LinearImage& image, bool sandbox)
    : JudgedTexture(image.width(), image.height(),
                    judged_texels(image.encoded(), image.width(), image.height(), sandbox),
                    image.encoded().threshold) {
  if (is_jpeg(image.encoded())) decoder_error_ = 2;
  const AlphaImage* const mask = image.encoded().mask.get();
  for (int64_t at = 0; mask != nullptr && at < width_ * height_; ++at) {
    const double u = (double(at % width_) + 0.5) / double(width_);
    const double v = (double(at / width_) + 0.5) / double(height_);
    rgba_[size_t(4 * at + 3)] =
        mask->at(int64_t(u * double(mask->width())), int64_t(v * double(mask->height())));
  }
}

WeightedColour JudgedTexture::at(const Paint& paint, double u, double v) const {
  static const std::array<double, 256> kLight = [] {
    std::array<double, 256> light;
    for (size_t i = 0; i < light.size(); ++i) light[i] = light_of_srgb(double(i));
    return light;
  }();
  WeightedColour sum{};
  const auto add = [&](int64_t i, int64_t j, double share) {
    const int64_t row = inside(j, height_, paint.wrap_v), column = inside(i, width_, paint.wrap_u);
    const uint8_t* const texel = &rgba_[size_t(4 * (row * width_ + column))];
    if (double(texel[3]) < threshold_) return;
    sum[0] += share;
    for (size_t c = 0; c < 3; ++c) sum[c + 1] += share * kLight[texel[c]];
  };
  if (paint.nearest) {
    add(int64_t(std::floor(u)), int64_t(std::floor(v)), 1);
    return sum;
  }
  const double i = std::floor(u - 0.5), j = std::floor(v - 0.5);
  const double s = u - 0.5 - i, t = v - 0.5 - j;
  add(int64_t(i), int64_t(j), (1 - s) * (1 - t));
  add(int64_t(i) + 1, int64_t(j), s * (1 - t));
  add(int64_t(i), int64_t(j) + 1, (1 - s) * t);
  add(int64_t(i) + 1, int64_t(j) + 1, s * t);
  return sum;
}

}  // namespace svdag
