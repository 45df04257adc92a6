// The options that decide the bytes of a bake, besides its scene: the one list of them.
//
// A bake, a plan and its shards copy this struct as a whole. The description of a bake
// (builder/bake/description.cpp) and the index of a plan (builder/farm/plan/plan_index.cpp) bind
// every member by name, so neither compiles while a new member is missing there.
#pragma once

#include <optional>

#include "io/dag/format.h"
#include "io/grid.h"

namespace svdag {

struct ContentOptions {
  Layout layout = Layout::kPlain;       // --layout
  Rule rule = Rule::kConservative;      // --rule, --inside
  int levels = 0;                       // -r: L of the grid; 0 if the voxel size is given instead
  double voxel_size = 0;                // --voxel-size, in world units; 0 if -r is given instead
  bool open_as_sheets = false;          // --open surface
  LayerKind layers = LayerKind::kNone;  // --layers
  bool with_union = true;               // --no-union
  std::optional<GridCube> cube;         // --cube, in world units; needs levels
  std::optional<Point> origin;          // --origin, in world units; needs voxel_size
  std::optional<Box> bounds;            // --bounds, in world units
};

}  // namespace svdag
