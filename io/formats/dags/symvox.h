// DAGs of SymVox, SVDAG-Compression and the DAGger web viewer: .svdag (another one than ours).
//
// Layout: the header of io/dag/symvox_header.h, then u32 words. The root is at word 0, levels
// follow each other. An inner node is its child mask and the absolute word index of each child, in
// *descending* order of the children; a node of level L-1 is one word, the mask of a 2^3 block. A
// brick of ours becomes a node and up to eight of the 255 masks there are.
#pragma once

#include <memory>
#include <string>

#include "io/dag/node_graph.h"
#include "io/formats/dags/level_dag.h"

namespace svdag {

// `grid`: of the level. 2^32 words and more are an Error (kUsage), and so is a box that is not
// finite in float32, or has no extent there.
void write_symvox(const LevelDag& dag, const Grid& grid, const std::string& path);

// `file` must outlive the graph. What is not such a file is an Error (kBadInput), and so are the
// mirrored nodes of a .ussvdag.
std::unique_ptr<NodeGraph> read_symvox(const File& file);

}  // namespace svdag
