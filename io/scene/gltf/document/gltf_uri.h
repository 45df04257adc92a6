// Resolves the URI of a glTF buffer or image: a file in the scene's folder, or data in the URI
// itself.
//
// A scene is untrusted: "../../etc/passwd", absolute paths, schemes, and symbolic links that leave
// the folder are rejected, and so is everything that is not a regular file.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "streaming/file/file.h"

namespace svdag {

inline bool is_data_uri(std::string_view uri) {
  return uri.starts_with("data:");
}

// The bytes of a base64 data URI; `path` names the scene in errors.
std::vector<std::byte> decode_data_uri(std::string_view uri, const std::string& path);

// Opens the file that a relative, percent-encoded URI in the scene file `scene_path` names. `kind`,
// for errors: buffer or image.
File open_beside(const std::string& scene_path, std::string_view uri, const std::string& kind);

}  // namespace svdag
