// Writer of ooc_svo_builder's octrees: X.octree (a text header), X.octreenodes, X.octreedata.
//
// A node is 24 bytes: u64 data (0 none, 1 the voxel of all binary octrees), u64 base, 8 x i8
// offset; child x + 2y + 4z is node base + offset, or missing if the offset is -1. Children precede
// their parents and the root is last. The children of a node must be contiguous, but two nodes may
// share them: the children of every *unique* node are written once, so the file has the size of the
// DAG and still opens as an octree. All voxels are node 0. Rejected: writing the octree itself (as
// many nodes as the SVO, voxels included).
#pragma once

#include <string>
#include <vector>

#include "io/formats/dags/whole_dag.h"

namespace svdag {

// The three files of `path`, which ends in .octree.
std::vector<std::string> octree_files(const std::string& path);

// Writes the three files.
void write_octree(const WholeDag& dag, const std::string& path);

}  // namespace svdag
