// Reader and writer of the .svo files (DAGs and trees) of the transform-aware DAG tools (2025).
//
// Layout: u32 magic, u32 version 2, u64 number of levels; per level, indexed by log2 of the side of
// its nodes, u64 n and n x 8 u32 children (numbers in the previous level, 0xffffffff: none); u64
// number of leaves and the leaves, u64 each, 4^3 voxels in Morton order; u32 resolution, u32 root
// level, u32 type (0 tree, 1 DAG). Levels 0 to 2 are empty, the root is node 0 of the last level.
// Children are numbered x + 2y + 4z, mirrored compared with ours. World coordinates are not stored.
#pragma once

#include <memory>
#include <string>

#include "io/dag/graph/node_graph.h"
#include "io/formats/dags/whole_dag.h"

namespace svdag {

constexpr uint32_t kTransformDagMagic = 72198382;

void write_transform_dag(const WholeDag& dag, const std::string& path);

// `file` must outlive the graph. Any other file is an Error (kBadInput).
std::unique_ptr<NodeGraph> read_transform_dag(const File& file);

}  // namespace svdag
