// The inputs of a command that it does not name: files that scenes and plans refer to.
#pragma once

#include "builder/farm/plan/plan.h"
#include "io/scene/scene.h"
#include "streaming/file/command_files.h"

namespace svdag {

// Adds the files that the scene's files refer to: buffers of glTF. Throws the errors of the reader.
void read_buffers(const SceneConfig& scene, uint64_t memory, CommandFiles* files);
// Adds the files and the inputs of a plan, except for the output of `own`: that step may write it,
// at its path in the plan.
void read_plan(const Plan& plan, const PlanStep* own, CommandFiles* files);

}  // namespace svdag
