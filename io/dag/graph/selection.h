// Which part of a `.svdag` file a command uses: --layer, --level and --bounds.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/dag/format.h"
#include "io/dag/layers/layer_palette.h"
#include "io/triangle.h"

namespace svdag {

struct Selection {
  // --layer: only these names and patterns (layers_named); the first root is their union.
  std::vector<std::string> layers{};
  std::optional<int> level{};      // --level: K, whose voxels are the cubes of 2^(L-K) voxels
  std::optional<Box> bounds{};     // --bounds: the voxels of the level that meet it, in world units
  Layout layout = Layout::kPlain;  // --layout, of the output of a command
  bool without_layers = false;     // only the set that a file shows first
  bool without_colours = false;    // --no-colours
  LayerPalette palette{};          // --palette: the colours of layers

  bool is_everything() const {
    return layers.empty() && !level && !bounds && !without_layers && palette.empty();
  }
};

}  // namespace svdag
