// The merges of a plan: a tree of neighbours, so that each makes the run of one contiguous part.
#pragma once

#include <cstddef>
#include <vector>

namespace svdag {

// A merge, by the numbers of what it reads: 0 .. leaves-1 are the leaves, then the merges in the
// order of the list. The last merge reads, directly or not, all.
using MergeTree = std::vector<std::vector<size_t>>;

// As even as `fan_in` (at least 2) allows; one merge at least.
MergeTree merge_tree(size_t leaves, size_t fan_in);

}  // namespace svdag
