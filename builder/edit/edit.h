// Edits `.svdag` files: set operations on two grids in the same place, a crop, a coarser level.
//
// An edit is a graph (io/dag/node_graph.h) that is reduced like an import
// (builder/import/graph_reduction.h), so that its result has the same bytes as a bake of these
// voxels: canonical, minimal, and never expanded. A crop is the intersection with a box, which is a
// graph of at most 64 nodes a level. A coarser level is a DAG whose bricks are made of its nodes.
//
// Files with layers are edited layer by layer (builder/edit/layer_pairs.h). The union of the result
// is that of the edited unions where this is the OR of the edited layers if it was before. The
// intersections and differences of layers have another OR, which is made of their nodes
// (builder/edit/united_graph.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/import/import.h"

namespace svdag {

enum class SetOperation { kUnion, kIntersection, kDifference };

struct EditConfig {
  std::string first;                      // path of a .svdag
  std::optional<std::string> second;      // of another one in the same place
  std::optional<SetOperation> operation;  // of the two; set if and only if `second` is
  std::optional<Box> bounds;              // --bounds: keeps the voxels in it, in world units
  std::optional<int> level;               // --level: K, whose voxels are cubes of 2^(L-K); alone
  std::vector<std::string> layers;        // --layer: of each file that has layers, only these
  std::string output;
  Layout layout = Layout::kPlain;  // --layout
  uint64_t memory = 0;             // --memory in bytes; 0: half of the machine
  std::string scratch;             // --scratch: the folder for scratch folders; empty: the output's
};

// Errors: kUsage if the grids differ in place or rule, or --level is not 3 .. L, or if the layers
// cannot be combined; kBadInput.
ImportReport edit(const EditConfig& config, Executor* executor);

}  // namespace svdag
