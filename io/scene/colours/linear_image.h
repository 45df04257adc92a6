// A texture as colours are sampled from it: linear light in 16 bits a channel, and its mip map.
//
// A texel holds red, green, blue and a weight. The weight of an opaque texel is 65535. A texel that
// a material cuts out weighs nothing and has no colour, so the colour of what is not there
// (magenta, in many files) reaches no mean: the channels of coarser texels are sums of weighted
// colours.
//
// A level has half the sides of the one before, rounded down, and a texel of it is the mean of what
// it covers there, shares of texels included. So every level covers the image evenly, and
// coordinates scale by the ratio of the sizes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "io/colour.h"
#include "io/scene/cutouts/alpha_image.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

constexpr uint16_t kWhite16 = 65535;  // linear light of 1

// The nearest 16 bits of light of 0 .. 1; what is outside is clamped, NaN is 0.
uint16_t light16(double light) noexcept;
// Of a value of sRGB of 0 .. 1, clamped as well.
uint16_t light16_of_srgb(double value) noexcept;

// An image as its file has it, for a judge that decodes it by other means.
struct EncodedImage {
  std::string name;                        // for errors
  std::vector<std::byte> bytes;            // PNG or JPEG
  double threshold = 0;                    // texels with an alpha below it are cut out
  std::shared_ptr<const AlphaImage> mask;  // its alpha counts instead, at the centres of texels
  MemoryBudget::Reservation memory;
};

class LinearImage {
 public:
  using Texel = std::array<uint16_t, 4>;  // red, green, blue: times weight / 65535; weight

  struct Level {
    int64_t width, height;
    std::vector<Texel> texels;  // rows from the top

    const Texel& at(int64_t i, int64_t j) const { return texels[size_t(j * width + i)]; }
  };

  // `rgba`: sRGB and alpha, rows from the top; both sides are at least 1. Texels with an alpha
  // below `threshold` are cut out.
  LinearImage(int64_t width, int64_t height, const std::vector<uint8_t>& rgba, double threshold,
              MemoryBudget::Reservation memory = {});
  explicit LinearImage(Level finest, MemoryBudget::Reservation memory = {});

  int64_t width() const { return levels_[0].width; }
  int64_t height() const { return levels_[0].height; }
  const std::vector<Level>& levels() const { return levels_; }
  // Whether texels are cut out.
  bool has_holes() const { return has_holes_; }
  // Empty, unless the images of the scene are kept (SceneConfig::keep_images).
  const EncodedImage& encoded() const { return encoded_; }
  void keep(EncodedImage encoded) { encoded_ = std::move(encoded); }
  // Most bytes of an image of so many texels.
  static uint64_t bytes(uint64_t texels) { return 3 * sizeof(Texel) / 2 * texels + 512; }

 private:
  void add_coarser_levels();

  MemoryBudget::Reservation memory_;
  std::vector<Level> levels_;  // the last has one texel
  bool has_holes_ = false;
  EncodedImage encoded_;
};

}  // namespace svdag
