#include "io/dag/layers/palette.h"

#include <span>

#include "streaming/file/checksum.h"

namespace svdag {

Colour palette_colour(std::string_view name) {
  constexpr uint64_t kHues = 48;
  constexpr double kTones[3][2] = {{0.85, 0.5}, {0.62, 0.5}, {0.95, 0.72}};  // bright; pale
  const uint64_t hash = checksum64(std::as_bytes(std::span(name)));
  const double hue = 6 * double(hash % kHues) / double(kHues);
  const auto& tone = kTones[hash / kHues % 3];
  const double bright = tone[0], pale = tone[1];
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    return colour_code(bright * (1 - (1 - pale) * std::clamp(std::min(k, 4 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

}  // namespace svdag
