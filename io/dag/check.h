// Proves, by pread alone, that a `.svdag` is sound: what a reader must know before it maps the file
// and follows pointers without looking.
//
// One pass in file order: checksums of all blocks and, because the deepest section is first, a
// bitmap of the node starts of one level suffices to check the pointers of the level above.
// Pointers lead strictly to the next level, so the graph is acyclic and bounded. Whether nodes are
// in order, unique and minimal is a question for verify/integrity/integrity.h.
#pragma once

#include "io/dag/format.h"
#include "streaming/file/file.h"

namespace svdag {

// Returns the header of a sound file; anything else is an Error (kBadInput) with path and offset.
Header check_dag(const File& file);

}  // namespace svdag
