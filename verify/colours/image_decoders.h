// PNG and JPEG by libpng and libjpeg-turbo: decoders that the builder does not use, so that a texel
// which stb_image gets wrong is found. JPEG leaves rounding to the decoder; colours of the two
// differ by a step or two.
#pragma once

#include <cstdint>
#include <vector>

#include "io/scene/colours/linear_image.h"

namespace svdag {

inline bool is_jpeg(const EncodedImage& image) {
  return image.bytes.size() > 2 && image.bytes[0] == std::byte{0xff};
}

// The texels of an image of this size, row by row from the top: red, green, blue in sRGB, alpha. Of
// 16 bits a channel, the upper eight. `sandbox`: in a process that can only compute, with a system
// call filter. An image that is broken, or of another size, is an Error (kBadInput). Error (kUsage)
// in a build without the libraries.
std::vector<uint8_t> judged_texels(const EncodedImage& image, int64_t width, int64_t height,
                                   bool sandbox);

}  // namespace svdag
