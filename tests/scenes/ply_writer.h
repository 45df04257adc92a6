// Writes a mesh as binary little-endian PLY, a few thousand elements at a time.
#pragma once

#include <optional>
#include <string>

#include "tests/scenes/mesh.h"

namespace svdag::scenes {

struct PlyOptions {
  bool double_precision = false;
  bool shuffle = false;  // vertices and faces in random-looking order
  uint64_t seed = 1;     // of the shuffling
  double yaw = 0;        // degrees, about the y axis through the origin
};

// The rounded position of vertex `i`, turned.
Point placed(const Mesh& mesh, const PlyOptions& options, uint64_t i);

// Replaces `path` atomically. A mesh of more than 2^32 vertices is an Error (kUsage).
void write_ply(const Mesh& mesh, const PlyOptions& options, const std::string& path);

}  // namespace svdag::scenes
