// The colours of the materials of an OBJ file, from the .mtl files that it names.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "io/colour.h"
#include "streaming/file/file.h"

namespace svdag {

// The .mtl files named by `mtllib` in the first 64 KiB of `obj`, beside it, as far as they exist.
std::vector<std::string> mtl_paths(const File& obj);

// By name: the diffuse colour Kd, which is sRGB. What cannot be read has no colour.
std::map<std::string, Colour> read_mtl_colours(const File& obj);

}  // namespace svdag
