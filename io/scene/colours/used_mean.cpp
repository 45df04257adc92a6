#include "io/scene/colours/used_mean.h"

#include <algorithm>
#include <cmath>

namespace svdag {

void UsedMean::add(TextureCorners corners) noexcept {
  if (!std::ranges::all_of(corners, is_placeable)) return;
  std::ranges::sort(corners);
  const auto& [a, b, c] = corners;
  const auto [low_v, high_v] = std::minmax({a.v, b.v, c.v});
  double span = std::max(c.u - a.u, high_v - low_v);
  size_t level = 0;
  for (; span > 4 && level + 1 < paint_.image->levels().size(); ++level) span /= 2;
  const LinearImage::Level& finest = paint_.image->levels()[0];
  const LinearImage::Level& sampled = paint_.image->levels()[level];
  const double by_u = double(sampled.width) / double(finest.width);
  const double by_v = double(sampled.height) / double(finest.height);
  const LevelSampler sampler(paint_, level, paint_.nearest);
  const double area = std::abs((b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v)) / 2;
  const auto units = uint64_t(std::clamp(std::ldexp(area, 20), 1.0, 0x1p60));
  constexpr double kParts[4][3] = {{4, 1, 1}, {1, 4, 1}, {1, 1, 4}, {2, 2, 2}};
  for (const auto& [of_a, of_b, of_c] : kParts) {
    const ColourSum sample = sampler.at((of_a * a.u + of_b * b.u + of_c * c.u) / 6 * by_u,
                                        (of_a * a.v + of_b * b.v + of_c * c.v) / 6 * by_v);
    for (size_t i = 0; i < 4; ++i) sums_[i] += (unsigned __int128)(units)*uint64_t(sample[int(i)]);
  }
}

std::optional<LinearColour> UsedMean::mean() const {
  std::array<double, 4> sums;
  std::ranges::copy(sums_, sums.begin());
  if (sums[3] == 0) std::ranges::copy(paint_.image->levels().back().texels[0], sums.begin());
  if (sums[3] == 0) return {};
  LinearColour colour;
  for (size_t c = 0; c < 3; ++c) colour.units[c] = light_units(sums[c] / sums[3]);
  return colour;
}

}  // namespace svdag
