// Proves that the union of a plain file holds exactly the voxels of its layers.
//
// A joint descent from all roots: a node of the union is compared with the distinct nodes that the
// layers have in its cube. A node alone with itself is equal, so the descent goes only where layers
// meet. Bricks are compared as bits. Questions recur in a DAG; a table keeps the last ones
// answered. Rejected: reducing the layers' OR to a DAG of its own, which needs the memory of a
// bake.
#pragma once

#include <cstdint>
#include <vector>

#include "io/dag/dag_view.h"

namespace svdag {

// `first`: the index of the union's root; `layers`: those of the layers, in any order. The file is
// valid and not empty.
bool is_union_of(const DagView& dag, uint32_t first, std::vector<uint32_t> layers);

}  // namespace svdag
