// Proves the levels of a run in one pass over its file: every block and the hash of all, that keys
// ascend and are not empty, that every child is inside the run, that every node is reached, and
// that what is between the sections is zero.
//
// Levels come bricks first, so the children of a level are marked in a bitmap of the level before:
// one bit per key, of one level at a time, is all that is held. A level that is too large for that
// is read again for each window of the bitmap. After this the run is canonical but for the number
// of its voxels, and who follows a rank in it stays inside.
#pragma once

#include "builder/run/run_file.h"

namespace svdag {

// Error (kBadInput) with the place where the run is damaged. `bitmap_bytes`: of the marks, at most.
void check_run(const RunFile& run, uint64_t bitmap_bytes, MemoryBudget* budget);

}  // namespace svdag
