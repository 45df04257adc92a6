// Writes a mesh as a GLB file: textures, vertex colours, skin and animation in one file.
//
// Vertices and triangles are streamed, a record of all attributes per vertex; a primitive is a run
// of triangles of one part and material. Rejected: an array per attribute (a pass over the mesh
// for each).
#pragma once

#include <string>

#include "tests/scenes/ply_writer.h"

namespace svdag::scenes {

// Replaces `path` atomically. A mesh without materials (tests/scenes/materials.h), shuffling, a
// turned skeleton and more than 4 GiB are Errors (kUsage).
void write_glb(const Mesh& mesh, const PlyOptions& options, const std::string& path);

}  // namespace svdag::scenes
