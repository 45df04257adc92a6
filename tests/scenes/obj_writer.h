// Writes a mesh as Wavefront OBJ, its parts as objects and materials, with an .mtl beside it.
#pragma once

#include <string>

#include "tests/scenes/ply_writer.h"

namespace svdag::scenes {

// Replaces `path`, which ends in ".obj", and the .mtl of that name. Shuffling is an Error (kUsage):
// it would cut the parts into pieces.
void write_obj(const Mesh& mesh, const PlyOptions& options, const std::string& path);

}  // namespace svdag::scenes
