// The merge tree of a plan: each merge reads neighbouring runs and writes one contiguous grid part.
#pragma once

#include <cstddef>
#include <vector>

namespace svdag {

// The inputs of each merge, by number: 0 .. leaves-1 are the leaves; then come the merges in list
// order. The last merge is the root.
using MergeTree = std::vector<std::vector<size_t>>;

// As even as possible, with at most `fan_in` (>= 2) inputs per merge and at least one merge.
MergeTree merge_tree(size_t leaves, size_t fan_in);

}  // namespace svdag
