// The name of a picture says its format; no other format is written under it.
#pragma once

#include <string>

#include "streaming/error.h"
#include "streaming/file/file_ending.h"

namespace svdag {

// A usage Error with `sentence` if `name` ends as pictures of another format than `written`
// (".png") do, in whatever case.
inline void refuse_other_pictures(const std::string& name, const std::string& written,
                                  const std::string& sentence) {
  for (const char* ending : {".png", ".ppm", ".jpg", ".jpeg", ".webp", ".gif", ".bmp", ".tif",
                             ".tiff", ".exr", ".hdr", ".tga"}) {
    if (ending != written && has_ending(name, ending)) fail_usage(name + ": " + sentence);
  }
}

}  // namespace svdag
