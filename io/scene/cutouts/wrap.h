// How a texture goes on beyond its borders: texel indices of any image size, in integers.
#pragma once

#include <algorithm>
#include <cstdint>

namespace svdag {

enum class Wrap : uint8_t { kRepeat, kMirror, kClamp };

// a / b, rounded down, for b > 0.
inline int64_t floor_div(int64_t a, int64_t b) noexcept {
  return a / b - (a % b < 0 ? 1 : 0);
}

// The texel, 0 .. size - 1, that texel i of an endless row is.
inline int64_t wrapped(int64_t i, int64_t size, Wrap wrap) noexcept {
  if (i >= 0 && i < size) return i;
  if (wrap == Wrap::kClamp) return std::clamp<int64_t>(i, 0, size - 1);
  const int64_t turn = floor_div(i, size), at = i - turn * size;
  return wrap == Wrap::kMirror && turn % 2 != 0 ? size - 1 - at : at;
}

}  // namespace svdag
