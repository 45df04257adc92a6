// The triangles of a plan: bins so fine that a shard reads little beyond its own.
//
// The split's triangles are distributed to bins (builder/split/triangle_bins.h), and heavy bins are
// divided again, until a bin is light, or a cell, or its triangles are so large that dividing would
// only copy them. The bins are stored in Morton order in one file, the blocks of each
// consecutively, so a shard reads a few long ranges. Rejected: a file per shard (triangles on
// borders and of large walls would be in many, and the shards could not be changed).
#pragma once

#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/split/split.h"

namespace svdag {

struct LeafConfig {
  uint64_t light = 0;       // triangles that need not be dealt again
  int deepest = 0;          // level of the smallest cubes that bins are made for
  uint64_t open_bytes = 0;  // for the blocks of bins that are being filled
};

// Writes the bins of `scene`, a split that is used up, to `out`.
std::vector<TriangleBin> make_leaf_bins(SplitScene* scene, const Grid& grid,
                                        const LeafConfig& config, Scratch* scratch, SpillFile* out);

// The bins that hold all triangles of `cells`.
std::vector<TriangleBin> bins_of(const std::vector<TriangleBin>& bins, const CellRange& cells,
                                 int levels);

}  // namespace svdag
