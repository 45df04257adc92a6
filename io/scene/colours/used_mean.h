// The mean colour of the part of a texture that triangles use: what a material looks like whose
// texture is an atlas.
//
// A triangle is sampled at the centroids of its four parts, at the level where it spans two to four
// texels, and counts by its area in the texture. One without area there, as where a texel is a
// palette's colour, counts 2^-20 texel. Sums of integers: any order of triangles and corners gives
// the same mean.
#pragma once

#include <array>
#include <optional>

#include "io/colour.h"
#include "io/scene/colours/paint.h"

namespace svdag {

class UsedMean {
 public:
  // `paint` has an image.
  explicit UsedMean(const Paint& paint) : paint_(paint) {}

  // Corners are in texels of the image. Does nothing for those that are not placeable.
  void add(TextureCorners corners) noexcept;
  // Of the whole image if nothing that was added is opaque; none if nothing of the image is.
  std::optional<LinearColour> mean() const;

 private:
  Paint paint_;
  std::array<unsigned __int128, 4> sums_{};  // red, green, blue, weight: times area
};

}  // namespace svdag
