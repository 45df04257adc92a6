// The texels of a PNG or JPEG image, or their alpha. Only image.cpp uses the stb_image library.
//
// The image is decoded in a limited child process: first its head, then, in memory that depends
// only on its size, its texels. So a smaller budget is an Error or makes no difference. Rejected:
// libpng and libjpeg, which would decode line by line, but whose versions differ in the colours of
// a JPEG.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct ImageSource {
  std::span<const std::byte> bytes;
  std::string path;      // for errors
  bool sandbox = false;  // with a system call filter
};

constexpr uint64_t kMaxImageSide = 16384;               // in texels
constexpr uint64_t kMaxImageBytes = uint64_t(1) << 30;  // of the file

// Error (kBadInput) if a file of `bytes` is too large for an image.
void check_image_bytes(uint64_t bytes, const std::string& path);

// The bytes of an image file, reserved in *memory.
std::vector<std::byte> bytes_of_image(const File& file, MemoryBudget* budget,
                                      MemoryBudget::Reservation* memory);

// The alpha of the texels, row by row from the top; in an image without alpha their luminance
// (77 R + 150 G + 29 B) / 256 if `or_luminance`, else 255.
struct AlphaTexels {
  int width = 0, height = 0;
  std::vector<uint8_t> alpha;
};
// Errors as above.
AlphaTexels alpha_of_image(const ImageSource& source, MemoryBudget* budget,
                           bool or_luminance = false);

// The texels, row by row from the top: red, green and blue in sRGB, and alpha (255 in an image
// without).
struct ColourTexels {
  int width = 0, height = 0;
  std::vector<uint8_t> rgba;
};
// Errors as above. The caller reserves the texels, 4 bytes each.
ColourTexels colours_of_image(const ImageSource& source, MemoryBudget* budget);

// An image that the child reduces to few texels.
constexpr int kThumbnailSide = 64;  // at most
struct Thumbnail {
  int width = 0, height = 0;
  std::vector<std::array<uint16_t, 4>> texels;  // row by row from the top, as reduce() returns them
};
// Errors as above. reduce() runs in the child and may hold 16 bytes a texel.
Thumbnail thumbnail_of_image(const ImageSource& source, MemoryBudget* budget,
                             const std::function<Thumbnail(const ColourTexels&)>& reduce);

}  // namespace svdag
