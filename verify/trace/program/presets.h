// Cameras that show a box, and their way around it.
#pragma once

#include <string>

#include "verify/trace/kernel/camera.h"

namespace svdag {

// The camera of a name: iso (three-quarter view from above), front, back, left, right, top (the
// whole box in view) or inside (past the middle, along the longer horizontal axis, wide).
// An unknown name is an Error (kUsage). `fov` in degrees.
Camera preset_camera(const std::string& name, const DagView& dag, const VoxelBounds& box, int up,
                     double fov, double aspect);

// Frame `frame` of `frames` of a full turn about the axis `up`: around the box's centre, or on the
// spot if the camera is inside the box.
Camera turned(const Camera& camera, const VoxelBounds& box, int up, int frame, int frames);

}  // namespace svdag
