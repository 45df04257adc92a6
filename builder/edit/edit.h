// Edits `.svdag` files: set operations on two grids in the same place, a crop, a coarser level.
//
// Of one file, it is a selection (io/dag/graph/select.h), which keeps the colours. Of two, it is a
// graph of the selected parts of both, combined, then cropped, that is reduced like an import
// (io/dag/graph/reduce.h). So its result has the same bytes as a bake of these voxels: canonical,
// minimal, and never expanded.
//
// Files with layers are edited layer by layer (builder/edit/layer_pairs.h). The union of the result
// is that of the edited unions where this is the OR of the edited layers if it was before. The
// intersections and differences of layers have another OR, which is made of their nodes
// (io/dag/graph/united_graph.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "builder/import/import.h"
#include "io/dag/graph/combined_graph.h"
#include "io/dag/graph/selection.h"

namespace svdag {

struct EditConfig {
  std::string first;                      // path of a .svdag
  std::optional<std::string> second;      // of another one in the same place
  std::optional<SetOperation> operation;  // of the two; set if and only if `second` is
  // Of each file that has layers, only the chosen ones; the bounds crop the result. No level with a
  // second file.
  Selection selection;
  std::string output;
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: the folder for scratch folders; empty: the output's
};

// Errors: kUsage if the grids differ in place or rule, or --level is not 3 .. L, or if the layers
// cannot be combined; kBadInput.
ImportReport edit(const EditConfig& config, Executor* executor);

}  // namespace svdag
