// Rejects names of pictures whose ending is that of another format.
#pragma once

#include <string>

#include "streaming/error.h"
#include "streaming/file/file_ending.h"

namespace svdag {

// Error (kUsage) with `sentence` if `name` has the ending of a picture format other than `written`
// (".png"), in upper or lower case.
inline void reject_other_picture_format(const std::string& name, const std::string& written,
                                        const std::string& sentence) {
  for (const char* ending : {".png", ".ppm", ".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tif",
                             ".tiff", ".exr", ".hdr", ".tga"}) {
    if (ending != written && has_ending(name, ending)) fail_usage(name + ": " + sentence);
  }
}

}  // namespace svdag
