// Colours of materials and layers.
#pragma once

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "io/trigonometry.h"

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

// Of "#rrggbb"; nothing for other texts.
inline std::optional<Colour> parse_colour(std::string_view text) {
  uint32_t rgb = 0;
  const char* const end = text.data() + text.size();
  if (text.size() != 7 || text[0] != '#' ||
      std::from_chars(text.data() + 1, end, rgb, 16).ptr != end)
    return std::nullopt;
  return Colour{uint8_t(rgb >> 16), uint8_t(rgb >> 8), uint8_t(rgb)};
}

// The nearest code of a channel of 0 .. 1 in sRGB; what is outside is clamped, NaN is 0.
inline uint8_t colour_code(double srgb) {
  return srgb > 0 ? uint8_t(std::lround(255 * std::min(srgb, 1.0))) : uint8_t(0);
}
// Linear light of a code (IEC 61966-2-1), or of a value between two codes: x^2.4 is x^2 times the
// fifth root of x^2.
inline double light_of(double code) {
  const double v = code / 255, x = (v + 0.055) / 1.055;
  return v <= 0.04045 ? v / 12.92 : x * x * fifth_root(x * x);
}

// Linear light in units of 2^-32, so that sums and comparisons are exact. The units of the codes
// and of the values halfway between them are the nearest: before they are rounded, none is within
// 0.0005 of the middle between two whole numbers.
constexpr uint64_t kWhiteUnits = uint64_t(1) << 32;

// The nearest units of light of 0 .. 1; what is outside is clamped, NaN is 0.
inline uint64_t light_units(double light) {
  return light > 0 ? uint64_t(std::llround(std::min(light, 1.0) * double(kWhiteUnits))) : 0;
}
// Linear light of a code in 16 bits.
inline uint16_t light16_of_code(uint8_t code) noexcept {
  static const std::array<uint16_t, 256> kLight = [] {
    std::array<uint16_t, 256> light;
    for (size_t i = 0; i < light.size(); ++i)
      light[i] = uint16_t(light_of(double(i)) * 65535 + 0.5);
    return light;
  }();
  return kLight[code];
}

// The nearest code.
inline uint8_t code_of_units(uint64_t units) {
  static const std::array<uint64_t, 255> kBorders = [] {
    std::array<uint64_t, 255> borders;
    for (size_t i = 0; i < borders.size(); ++i) borders[i] = light_units(light_of(double(i) + 0.5));
    return borders;
  }();
  return uint8_t(std::upper_bound(kBorders.begin(), kBorders.end(), units) - kBorders.begin());
}

// Linear light of the three channels; white unless set.
struct LinearColour {
  std::array<uint64_t, 3> units{kWhiteUnits, kWhiteUnits, kWhiteUnits};

  // `factor` is linear light.
  Colour times(const std::array<double, 3>& factor) const {
    const auto code = [&](size_t c) {
      return code_of_units(light_units(factor[c] * double(units[c]) / double(kWhiteUnits)));
    };
    return {code(0), code(1), code(2)};
  }
};

}  // namespace svdag
