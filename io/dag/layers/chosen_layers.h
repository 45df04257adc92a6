// Several layers of a file, and their union, as a file without the others: for --layer, given more
// than once.
//
// The union of the chosen layers is not a node of the file, as that of all layers is. A node of it is
// a set of nodes of the file, whose voxels are together; a set of one is that node. So new nodes
// are made only where the chosen layers meet. Sets are numbered top-down, level by level, and
// written bottom-up, in the order of all nodes.
//
// Memory, in the budget: 1.5 bits for each index of the file's levels, and about 60 bytes for each
// set of several nodes; 12 bytes for each node of two levels, which may go to files.
#pragma once

#include <span>

#include "io/dag/dag_file.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The file of these layers, ascending numbers of the table of `file`, which is plain. Its first
// root is that of their union. All layers of a file whose union is that of its layers give its
// bytes.
DagFile chosen_layers(const DagFile& file, std::span<const size_t> chosen, const WorkRoom& room);

}  // namespace svdag
