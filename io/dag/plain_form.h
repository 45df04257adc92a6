// The plain layout of a file in the compact layout: the same nodes in content order.
//
// Levels are rewritten from the bricks up: the children of a node are replaced by their indices in
// the plain layout, then the nodes of the level are sorted by their children, out of core.
#pragma once

#include <string>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The file itself if its layout is plain, else its plain form, which has no name. Error (kBadInput)
// if the plain form does not have the content hash of the file.
DagFile plain_form(DagFile file, const WorkRoom& room);

}  // namespace svdag
