// What commands that read scenes have in common: notes to the user about a scene, and the input
// files that the command line does not name.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "builder/farm/plan/plan.h"
#include "io/scene/scene.h"
#include "streaming/file/command_files.h"

namespace svdag {

// Prints a line on stdout for each pattern that matches no part and each texture that cannot be
// read, one for each kind of what a reader left out, and one if triangles are undeformed (skins and
// morph targets are not applied).
void print_scene_notes(const SceneCounts& counts);
// The rest of a line: how many colours, and how large.
void print_colours(const ColourReport& report);
void print_colour_hash(const ColourReport& report);
void print_nothing_to_resume(const std::string& output, const std::string& scratch);
// For reports: the counts that are not 0, by name.
std::map<std::string, uint64_t> left_out_json(const LeftOut& left_out);

// Adds the files that the scene's files refer to: buffers of glTF. Throws the errors of the reader.
void read_buffers(const SceneConfig& scene, uint64_t memory, CommandFiles* files);
// Adds the files and the inputs of a plan, except for the output of `own`: that step may write it,
// at its path in the plan.
void read_plan(const Plan& plan, const PlanStep* own, CommandFiles* files);

}  // namespace svdag
