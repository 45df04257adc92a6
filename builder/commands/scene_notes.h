// Notes to the user about a scene, common to all commands that read scenes.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "io/scene/scene.h"

namespace svdag {

// Prints a line on stdout for each pattern that matches no part and each texture that cannot be
// read, one for each kind of what a reader left out, and one if triangles are undeformed (skins and
// morph targets are not applied).
void print_scene_notes(const SceneCounts& counts);
// For reports: the counts that are not 0, by name.
std::map<std::string, uint64_t> left_out_json(const LeftOut& left_out);

}  // namespace svdag
