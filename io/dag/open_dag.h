// Opens a file for a program: how every command reads its `.svdag`.
#pragma once

#include <string>

#include "io/dag/dag_file.h"
#include "io/dag/graph/selection.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// Whether the file begins as a .svdag, packed or not. Error (kBadInput) if it cannot be read.
bool begins_as_dag(const std::string& path);

// Opens a .svdag (DagFile::open), or a packed one, which is unpacked to a file without a name. A
// selection is a file without a name, too. `room`: for such files; null: TMPDIR, and half of the
// memory.
DagFile open_dag(const std::string& path, const Selection& selection = {},
                 const WorkRoom* room = nullptr);

}  // namespace svdag
