// What people should know of a scene that was read, whichever command read it.
#pragma once

#include "io/scene/scene.h"

namespace svdag {

// A line each on stdout, or nothing: patterns that match no part, triangles that are not deformed.
void print_scene_notes(const SceneCounts& counts);

}  // namespace svdag
