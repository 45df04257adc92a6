// DAGs of HashDAG and its heirs (GPU-SVDAG-Editing, VkHashDAG): NAME{N/1024}k.basic_dag.dag.bin.
//
// Layout: box minimum and maximum (3 x f64 each), u32 levels = log2 N, u64 number of words, words.
// The root is at word 0; an inner node is its child mask (low 8 bits; the upper 24 belong to
// colours) and the absolute word index of each child, ascending; a leaf, at level L-2, is a brick
// in two words, the low one first. Children and bits are numbered as ours. The file's name is part
// of the contract: the programs make it from the depth that they were compiled for, at most 17.
// Their colours are not written: the programs are compiled without, or want a colour per voxel.
#pragma once

#include <memory>
#include <string>

#include "io/dag/node_graph.h"
#include "io/formats/dags/level_dag.h"

namespace svdag {

// The name that the programs look for, if the user gave `path` = DIR/NAME; `path` itself if it
// has the ending already. N below 1K has no such name: an Error (kUsage) says so.
std::string hashdag_path(const std::string& path, int levels);

// `grid`: of the level. More than 2^17 voxels or 2^32 - 1 words are an Error (kUsage).
void write_hashdag(const LevelDag& dag, const Grid& grid, const std::string& path);

// `file` must outlive the graph. What is not such a file is an Error (kBadInput).
std::unique_ptr<NodeGraph> read_hashdag(const File& file);

}  // namespace svdag
