// Proves that the union of a plain file holds exactly the voxels of its layers.
//
// A joint descent from all roots: a node of the union is compared with the distinct nodes that the
// layers have in its cube. A node compared only with itself is equal, so the descent goes only
// where layers meet. Bricks are compared as bits. Subproblems recur in a DAG; a table keeps the
// last ones. A hostile file can have very many: after kMaxUnionNodes nodes of layers, nothing is
// proved. Rejected: reducing the layers' OR to a DAG of its own, which needs the memory of a bake.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "io/dag/dag_view.h"

namespace svdag {

constexpr uint64_t kMaxUnionNodes = uint64_t(1) << 32;

// `first`: the index of the union's root; `layers`: of the layers' roots, in any order. The file is
// valid and not empty. Nothing if it takes more than `max_nodes` nodes.
std::optional<bool> is_union_of(const DagView& dag, uint32_t first, std::vector<uint32_t> layers,
                                uint64_t max_nodes = kMaxUnionNodes);

}  // namespace svdag
