// The triangles of a plan, in bins so fine that a shard reads few triangles outside its cells.
//
// The split's triangles are distributed to bins (builder/split/triangle_bins.h). Heavy bins are
// divided again until they are light, as small as a cell, or hold triangles so large that dividing
// would only copy them. All bins are in one file in Morton order, each in consecutive blocks, so a
// shard reads a few long ranges. Rejected: a file per shard (triangles on borders and large walls
// would be in many files, and the shards could not be changed).
#pragma once

#include <vector>

#include "builder/octree/grid_part.h"
#include "builder/split/split.h"

namespace svdag {

struct LeafConfig {
  uint64_t light = 0;       // a bin with at most this many triangles is not divided
  int max_level = 0;        // level of the smallest cubes that get bins
  uint64_t open_bytes = 0;  // memory for the blocks of bins that are being filled
};

// Writes the bins of `scene` to `out`; consumes the split.
std::vector<TriangleBin> make_leaf_bins(SplitScene* scene, const Grid& grid,
                                        const LeafConfig& config, Scratch* scratch, SpillFile* out);

// The bins that overlap `cells`; together they hold all triangles of the cells.
std::vector<TriangleBin> bins_of(const std::vector<TriangleBin>& bins, const CellRange& cells,
                                 int levels);

}  // namespace svdag
