// Colours of materials and layers.
#pragma once

#include <algorithm>
#include <cmath>
#include <compare>
#include <cstdint>
#include <cstdio>
#include <string>

namespace svdag {

// An sRGB colour, 8 bits a channel.
struct Colour {
  uint8_t r = 0, g = 0, b = 0;
  auto operator<=>(const Colour&) const = default;
};

// "#rrggbb".
inline std::string colour_text(const Colour& colour) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", colour.r, colour.g, colour.b);
  return text;
}

// The nearest code of a channel of 0 .. 1 in sRGB; what is outside is clamped, NaN is 0.
inline uint8_t colour_code(double srgb) {
  return srgb > 0 ? uint8_t(std::lround(255 * std::min(srgb, 1.0))) : uint8_t(0);
}
// Of linear light (IEC 61966-2-1).
inline uint8_t colour_code_of_light(double light) {
  return colour_code(light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1 / 2.4) - 0.055);
}
// Linear light of a code.
inline double light_of(uint8_t code) {
  const double v = code / 255.0;
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

}  // namespace svdag
