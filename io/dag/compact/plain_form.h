// The plain layout of a file in the compact layout: the same nodes in content order.
//
// Levels are rewritten from the bricks up: the children of a node are replaced by their indices in
// the plain layout, then the nodes of the level are sorted by their children, out of core.
#pragma once

#include <optional>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The plain form of a compact file; it has no name. None if the layout is plain already. Error
// (kBadInput) if it does not have the content hash of the file.
std::optional<DagFile> plain_form(const DagFile& file, const WorkRoom& room);

}  // namespace svdag
