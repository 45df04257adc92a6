// Counts the work of a colour pass, in one read of the scene with its textures.
//
// A triangle at a random position meets V / s^3 cubes of side s on average, V the volume of its sum
// with a cube: s^3 + s^2 (extents along the axes) + s (areas of the projections along them). So
// three sums over the triangles give the pairs at any level, and the level is chosen afterwards.
// Triangles of one colour end the walk early and do not count.
#pragma once

#include "builder/colours/colour_pass.h"
#include "builder/farm/planner/predict.h"

namespace svdag {

// `scene` must be read with `colours` and `paint`.
ColourWork survey_colours(const Scene& scene, const Grid& grid, const ColourPassConfig& pass,
                          Workspace* workspace, SceneCounts* counts);

}  // namespace svdag
