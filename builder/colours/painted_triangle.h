// A snapped triangle with what colours its points.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "io/scene/colours/paint.h"
#include "io/triangle.h"

namespace svdag {

constexpr uint32_t kOneColour = UINT32_MAX;

struct PaintedTriangle {
  struct Corner {
    LatticePoint position{0};
    TexturePoint texture{0, 0};                                    // in texels of the finest level
    std::array<uint16_t, 3> colour{kWhite16, kWhite16, kWhite16};  // linear light
  };
  std::array<Corner, 3> corners;
  // An index of Paints, or kOneColour: all points have the colour of corner 0.
  uint32_t paint = kOneColour;

  bool has_one_colour() const { return paint == kOneColour; }
  LatticeTriangle triangle() const {
    return {{corners[0].position, corners[1].position, corners[2].position}};
  }
};
using Paints = std::vector<Paint>;

// The colour of all points, if a paint without a texture gives the corners one.
inline std::optional<std::array<uint16_t, 3>> one_colour(const Paint& paint,
                                                         const CornerColours& corners) {
  if (paint.image || corners[0] != corners[1] || corners[0] != corners[2]) return {};
  std::array<uint16_t, 3> colour;
  for (size_t c = 0; c < 3; ++c)
    colour[c] = light16(paint.factor[c] * double(corners[0][c]) / kWhite16);
  return colour;
}

// Sorts the corners, by position first: neither order nor winding of the triangle affects what is
// computed of it.
inline void sort_corners(PaintedTriangle* t) {
  const auto key = [](const PaintedTriangle::Corner& c) {
    return std::make_tuple(c.position.x, c.position.y, c.position.z, c.texture.u, c.texture.v,
                           c.colour);
  };
  std::ranges::sort(t->corners, {}, key);
}

}  // namespace svdag
