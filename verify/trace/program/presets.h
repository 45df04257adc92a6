// Named cameras that show a box, and their turn around it.
#pragma once

#include <string>

#include "verify/trace/kernel/camera.h"

namespace svdag {

// The camera called `name`: iso (three-quarter view from above), front, back, left, right, top
// (these show the whole box) or inside (a wide view through the middle, along the longer horizontal
// axis). `fov` is in degrees; inside ignores it. Error (kUsage) if the name is unknown.
Camera preset_camera(const std::string& name, const DagView& dag, const VoxelBounds& box, int up,
                     double fov, double aspect);

// The camera of frame `frame` of `frames` in a full turn about the axis `up`: around the centre of
// the box, or in place if the camera is inside the box.
Camera turned(const Camera& camera, const VoxelBounds& box, int up, int frame, int frames);

}  // namespace svdag
