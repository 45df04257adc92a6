// Named cameras that show a box, and their turn around it.
#pragma once

#include <string>

#include "verify/trace/kernel/camera.h"

namespace svdag {

// The camera called `name`: iso (three-quarter view from above), front, back, left, right, top
// (these show all voxels in the box, or the box of an empty DAG) or inside (a wide horizontal view
// from an enclosed empty point). `fov` is in degrees; inside ignores it. Error (kUsage) if the name
// is unknown.
Camera preset_camera(const std::string& name, const DagView& dag, const VoxelBounds& box, int up,
                     double fov, double aspect);

// A box that contains `box` at every turn about the axis `up`, with the same centre.
VoxelBounds turntable_bounds(VoxelBounds box, int up);

// The camera of frame `frame` of `frames` in a full turn about the axis `up`: around the centre of
// the box, or in place if the camera is inside the box.
Camera turned(const Camera& camera, const VoxelBounds& box, int up, int frame, int frames);

}  // namespace svdag
