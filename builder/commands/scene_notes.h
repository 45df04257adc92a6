// Notes to the user about a scene, common to all commands that read scenes.
#pragma once

#include "io/scene/scene.h"

namespace svdag {

// Prints a line on stdout for each pattern that matches no part and each texture that cannot be
// read, and one if triangles are undeformed (skins and morph targets are not applied).
void print_scene_notes(const SceneCounts& counts);

}  // namespace svdag
