// Reader and writer of the DAG files of SymVox, SVDAG-Compression and the DAGger web viewer. Their
// ending is .svdag too, but the format is not ours.
//
// Layout: the header of io/dag/symvox_header.h, then u32 words. The root is at word 0, the levels
// follow in order. An inner node is its child mask and the absolute word index of each child, in
// *descending* order of the children; a node of level L-1 is one word, the mask of a 2^3 block. Our
// brick becomes one node and up to eight of the 255 possible masks.
#pragma once

#include <memory>
#include <string>

#include "io/dag/graph/node_graph.h"
#include "io/formats/dags/whole_dag.h"

namespace svdag {

// 2^32 words or more are an Error (kUsage), and so is a box that is not finite, or has no extent,
// in float32.
void write_symvox(const WholeDag& dag, const std::string& path);

// `file` must outlive the graph. Any other file is an Error (kBadInput), and so are the mirrored
// nodes of a .ussvdag.
std::unique_ptr<NodeGraph> read_symvox(const File& file);

}  // namespace svdag
