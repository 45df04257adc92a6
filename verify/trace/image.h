// A picture of 8-bit RGB, and its PNG encoder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "verify/trace/kernel/traverse.h"

namespace svdag {

struct Image {
  int width = 0;
  int height = 0;
  std::vector<uint8_t> rgb;  // row after row from the top, 3 bytes a pixel

  Image(int w, int h) : width(w), height(h), rgb(size_t(w) * size_t(h) * 3) {}
  // Stores a colour in linear light, as sRGB.
  void set(int x, int y, const Vec3& linear);
  // Stores values without conversion, for normals and depths.
  void set_raw(int x, int y, const Vec3& value);
};

// The bytes of a PNG. Error (kOutput) with `path` if memory does not suffice.
std::vector<std::byte> encode_png(const Image& image, const std::string& path);
// Replaces `path` atomically. Error: kOutput.
void write_png(const Image& image, const std::string& path);

}  // namespace svdag
