// PNG files for tests, written from the specification alone.
#pragma once

#include <zlib.h>

#include <cstdint>
#include <string>

namespace svdag {

inline std::string big_endian(uint32_t value) {
  return {char(value >> 24), char(value >> 16), char(value >> 8), char(value)};
}

inline std::string png_chunk(const std::string& type, const std::string& data) {
  const std::string body = type + data;
  const auto sum = crc32(0, reinterpret_cast<const Bytef*>(body.data()), uInt(body.size()));
  return big_endian(uint32_t(data.size())) + body + big_endian(uint32_t(sum));
}

enum class PngKind : char { kGrey = 0, kRgb = 2, kPalette = 3, kGreyAlpha = 4, kRgba = 6 };

// `texels`: the bytes of all rows, big-endian if depth is 16. `more`: chunks before the texels.
inline std::string png(uint32_t width, uint32_t height, PngKind kind, const std::string& texels,
                       char depth = 8, const std::string& more = {}) {
  std::string rows;
  const size_t row = texels.size() / height;
  for (size_t y = 0; y < height; ++y) rows += '\0' + texels.substr(y * row, row);
  uLongf size = compressBound(uLong(rows.size()));
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size,
           reinterpret_cast<const Bytef*>(rows.data()), uLong(rows.size()));
  packed.resize(size);
  return "\x89PNG\r\n\x1a\n" +
         png_chunk("IHDR", big_endian(width) + big_endian(height) + depth + char(kind) +
                               std::string(3, '\0')) +
         more + png_chunk("IDAT", packed) + png_chunk("IEND", "");
}

// One texel.
inline std::string rgb(int r, int g, int b) {
  return {char(r), char(g), char(b)};
}

// A PNG of one texel.
inline std::string one_texel(int r, int g, int b) {
  return png(1, 1, PngKind::kRgb, rgb(r, g, b));
}

}  // namespace svdag
