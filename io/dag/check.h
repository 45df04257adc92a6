// Validates a `.svdag` file by pread only, so that a reader may then map it and follow its
// pointers without checks. Of a compact file only the checksums: io/dag/compact/compact_check.h
// checks the structure of what is mapped.
//
// One pass in file order verifies the checksums of all blocks and the structure. The deepest
// section is first, so a bitmap of the node starts of one level suffices to check the pointers of
// the level above. Pointers lead to the next level only, so the graph is acyclic and bounded.
// Whether nodes are in order, unique and minimal is checked by verify/integrity/integrity.h.
#pragma once

#include "io/dag/format.h"
#include "streaming/file/file.h"

namespace svdag {

// Error (kBadInput) unless the header is valid. The places of the parts are not checked.
void check_header(const File& file, const Header& header);

// Returns the header of a valid file; Error (kBadInput) with path and offset for any other.
Header check_dag(const File& file);

}  // namespace svdag
