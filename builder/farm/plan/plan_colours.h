// The colours of a plan: how its last step reads the scene again, and the pass that it then makes.
//
// They are in plan.json. The step hashes the files of the scene first, since a changed scene would
// colour other voxels.
// Rejected: the triangles of the pass and the decoded textures as files of the plan, so that the
// step needs no scene. They are several times the size of the scene, and are read once.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "builder/colours/colour_pass.h"
#include "io/scene/scene.h"

namespace svdag {

struct PlanColours {
  ColourPassConfig pass;
  SceneConfig scene;  // with absolute paths; its transform is in the file that gets the colours
};

nlohmann::ordered_json colours_json(const PlanColours& colours);
// Throws Json::exception or Error (kBadInput) if it is not one that colours_json() returns.
PlanColours get_colours(const nlohmann::ordered_json& json);

}  // namespace svdag
