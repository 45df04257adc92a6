// Textures drawn by formulas, encoded as PNG or JPEG: the same bytes on every machine.
//
// A formula gives the colour at a point of [0, 1]^2. Those of textures that repeat are periodic, so
// that no seam shows.
#pragma once

#include <glm/vec4.hpp>
#include <string>

namespace svdag::scenes {

using Texel = glm::dvec4;  // red, green, blue, sRGB, and alpha; 0 .. 1

struct Texture {
  int width, height;
  bool jpeg;  // else PNG
  bool mask;  // has alpha
  Texel (*paint)(double u, double v);
};

// Courses of large blocks.
extern const Texture kLimestone;
// Veins.
extern const Texture kMarble;
// Courses of bricks; not periodic, to be mirrored.
extern const Texture kBricks;
// A floor of 4 x 4 tiles with a star in the middle.
extern const Texture kMosaic;
// Plain tiles, 4 x 4.
extern const Texture kTerracotta;
// Cloth with ogees and flowers.
extern const Texture kRedBrocade, kBlueBrocade;
// A fern's leaf, opaque only where it is.
extern const Texture kFern;
// An atlas of 2 x 2 cells: three vases and a capital.
extern const Texture kPainted;

// The file of the image.
std::string encoded(const Texture& texture);

}  // namespace svdag::scenes
