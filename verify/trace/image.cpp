#include "verify/trace/image.h"

#include <algorithm>
#include <cmath>

#include "streaming/error.h"
#include "streaming/file/atomic_file.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#define STBI_WRITE_NO_STDIO
#include <stb/stb_image_write.h>

namespace svdag {
namespace {

uint8_t to_byte(double value) {
  return uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0)));
}

double srgb(double v) {
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}

}  // namespace

void Image::set(int x, int y, const Vec3& linear) {
  set_raw(x, y, {{srgb(linear[0]), srgb(linear[1]), srgb(linear[2])}});
}

void Image::set_raw(int x, int y, const Vec3& value) {
  uint8_t* pixel = &rgb[(size_t(y) * size_t(width) + size_t(x)) * 3];
  for (int a = 0; a < 3; ++a) pixel[a] = to_byte(value[a]);
}

std::vector<std::byte> encode_png(const Image& image, const std::string& path) {
  std::vector<std::byte> bytes;
  const auto append = [](void* context, void* data, int size) {
    auto* out = static_cast<std::vector<std::byte>*>(context);
    const auto* from = static_cast<const std::byte*>(data);
    out->insert(out->end(), from, from + size);
  };
  if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(),
                             image.width * 3) == 0)
    throw Error(ExitCode::kOutput, "the picture could not be encoded: choose a smaller --size",
                path);
  return bytes;
}

void write_png(const Image& image, const std::string& path) {
  const std::vector<std::byte> bytes = encode_png(image, path);
  AtomicFile file(path);
  file.append(bytes);
  file.commit();
}

}  // namespace svdag
