// Which sets of two files a set operation combines.
//
// * Two files with layers: layers of the same name; a layer that a file lacks is empty there. A
//   union has the names of both, the other operations have the names of the first file.
// * A file without layers in a union has what it holds in the unnamed layer. In an intersection or
//   a difference it is a mask for every layer. So is, subtracted from it, the union of the other.
#pragma once

#include <string>
#include <vector>

#include "io/dag/graph/combined_graph.h"
#include "io/dag/layers/layer_table.h"

namespace svdag {

// The sets of a file: of the union, if `layers` has it, and of each layer, with their roots.
struct LayerSets {
  std::string path;
  LayerTable layers;
  std::vector<uint32_t> roots;

  uint32_t of_union() const { return roots.front(); }
  uint32_t of_layer(size_t i) const { return roots[i + size_t(layers.has_union)]; }
};

struct LayerPairs {
  LayerTable layers;            // of the result; roots and voxels are not set
  std::vector<NodePair> roots;  // of the union, unless it must be made, and of each layer
  bool needs_union = false;     // the OR of the layers is to be added as the first root
};

// Error (kUsage) if the layers are of different kinds, if there are too many, or if a union is
// needed that its file does not have.
LayerPairs match_layers(SetOperation operation, LayerSets a, LayerSets b);

}  // namespace svdag
