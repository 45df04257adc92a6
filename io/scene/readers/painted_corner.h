// What colours the points of a polygon that a decoder sends: a texture, colours of its corners, or
// both.
#pragma once

#include <cstdint>

#include "io/scene/colours/paint.h"

namespace svdag {

struct PaintedCorner {
  double u = 0, v = 0;  // of 0 .. 1, v from the top of the image
  VertexColour colour = kWhiteCorners[0];
  uint16_t padding = 0;
};

struct NamedPaint {
  uint32_t image = 0;  // its number, from 1 on; 0: none
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  uint8_t is_nearest = 0, padding = 0;
};

}  // namespace svdag
