// Rows of colours as they are met along a surface, for tests and benchmarks.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "io/dag/colours/chunk_view.h"

namespace svdag {

inline uint32_t rgb(int r, int g, int b) {
  const auto clamped = [](int v) { return uint32_t(std::clamp(v, 0, 255)); };
  return clamped(r) | clamped(g) << 8 | clamped(b) << 16;
}

inline std::vector<uint32_t> noise(size_t count, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<uint32_t> colours(count);
  for (uint32_t& colour : colours) colour = uint32_t(random()) & 0xffffff;
  return colours;
}

// Plain areas, gradients with noise of a texture, jumps to other charts, noise, and, if `gaps`,
// cubes without colour.
inline std::vector<uint32_t> textured(size_t count, uint64_t seed, bool gaps = false) {
  std::mt19937_64 random(seed);
  const auto below = [&](int n) { return int(random() % uint64_t(n)); };
  std::vector<uint32_t> colours;
  while (colours.size() < count) {
    const int length = 1 + below(below(8) == 0 ? 3000 : 200), kind = below(gaps ? 6 : 5);
    const int from[3] = {below(256), below(256), below(256)};
    const int to[3] = {below(256), below(256), below(256)},
              grain = below(4) == 0 ? 30 : 1 + below(6);
    for (int i = 0; i < length && colours.size() < count; ++i) {
      if (kind == 5) {
        colours.push_back(kNoColour);
        continue;
      }
      int c[3];
      const int shade = below(2 * grain + 1) - grain;
      for (int a = 0; a < 3; ++a) {
        c[a] = from[a];
        if (kind == 1) c[a] += (to[a] - from[a]) * i / length;
        if (kind != 0) c[a] += shade + below(3) - 1;
        if (kind == 4) c[a] = below(256);
      }
      colours.push_back(rgb(c[0], c[1], c[2]));
    }
  }
  return colours;
}

inline int squared_distance(uint32_t a, uint32_t b) {
  int sum = 0;
  for (int shift = 0; shift < 24; shift += 8) {
    const int d = int(a >> shift & 255) - int(b >> shift & 255);
    sum += d * d;
  }
  return sum;
}

}  // namespace svdag
