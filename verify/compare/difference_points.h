// Writes the voxels in which two DAGs differ as points that any mesh viewer shows.
#pragma once

#include <string>

#include "io/grid.h"
#include "verify/compare/diff.h"

namespace svdag {

// Writes a binary PLY of the centres of differing voxels: red where only A is set, blue where only
// B. `grid` is A's. More than `max_points` voxels are an Error (kUsage). Call after diff->count().
void write_difference(DagDiff* diff, const DiffCounts& counts, const Grid& grid,
                      const std::string& path, uint64_t max_points);

}  // namespace svdag
