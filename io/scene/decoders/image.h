// The mean colour of a PNG or JPEG image. Only image.cpp uses the stb_image library.
//
// The image is decoded in a limited child process: first its head, then, in memory that depends on
// its size alone, its texels. So a smaller budget is an Error or makes no difference.
// Rejected: libpng and libjpeg, which would decode line by line, but whose versions differ in the
// colours of a JPEG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "io/colour.h"
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

// Means of the texels of an image in linear light.
struct ImageMean {
  LinearColour visible;  // weighted by alpha, unless that is zero everywhere
  LinearColour all;      // for materials that ignore alpha
};

// Of 16 bits a channel, the upper eight count. An image that is broken, too large or of another
// format is an Error (kBadInput).
ImageMean mean_of_image(const ImageSource& source, MemoryBudget* budget);

}  // namespace svdag
