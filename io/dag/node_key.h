#pragma once

#include <array>
#include <cstdint>

namespace svdag {

// The children of a node: 0 = absent, otherwise 1 + the child's index (word or brick) one level
// down. Compared lexicographically, child 0 first: the canonical order.
using NodeKey = std::array<uint32_t, 8>;

}  // namespace svdag
