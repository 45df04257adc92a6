// The check of a run's levels, in one pass over its file.
//
// It proves that every block matches its checksum and all of them the content hash, that keys
// ascend and are not empty, that every child is inside the run, that every node is reached from a
// root, and that the gaps between sections are zero.
//
// Levels are stored bricks first, so the children in a level are marked in a bitmap of the level
// read before: one bit per key, for one level at a time. If a level has more keys than the bitmap
// has bits, the level above is read again for each further window of the bitmap. After this check
// the run is canonical except for its voxel count, and every rank in it is valid.
#pragma once

#include "builder/run/run_file.h"

namespace svdag {

// Error (kBadInput) with the offset of the damage. `bitmap_bytes`: largest size of the bitmap.
void check_run(const RunFile& run, uint64_t bitmap_bytes, MemoryBudget* budget);

}  // namespace svdag
