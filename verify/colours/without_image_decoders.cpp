// Replaces image_decoders.cpp in builds without libpng and libjpeg-turbo.
#include "streaming/error.h"
#include "verify/colours/image_decoders.h"

namespace svdag {

#ifndef SVDAG_HAS_IMAGE_DECODERS
std::vector<uint8_t> judged_texels(const EncodedImage&, int64_t, int64_t, bool) {
  fail_usage(
      "this svdag-verify was built without libpng and libjpeg-turbo, which decode the textures of "
      "the scene: build it with -DSVDAG_IMAGE_DECODERS=ON");
}
#endif

}  // namespace svdag
