// Reader and writer of the DAG files of HashDAG and its successors (GPU-SVDAG-Editing, VkHashDAG):
// NAME{N/1024}k.basic_dag.dag.bin.
//
// Layout: box minimum and maximum (3 x f64 each), u32 levels = log2 N, u64 number of words, words.
// The root is at word 0. An inner node is its child mask (low 8 bits; the upper 24 hold colours)
// followed by the absolute word index of each child, in ascending child order. A leaf, at level
// L-2, is a brick in two words, the low word first. Children and bits are numbered as ours. The
// file name is part of the format: the programs derive it from the depth they were compiled for, at
// most 17. Colours are not written: the programs are compiled without them, or need a colour per
// voxel.
#pragma once

#include <memory>
#include <string>

#include "io/dag/node_graph.h"
#include "io/formats/dags/level_dag.h"

namespace svdag {

// The file name that the programs expect for `path` = DIR/NAME; `path` itself if it already has the
// ending. Grids below 1K have no such name: Error (kUsage).
std::string hashdag_path(const std::string& path, int levels);

// `grid` is that of the exported level. More than 2^17 voxels per axis, or 2^32 - 1 words or more,
// are an Error (kUsage).
void write_hashdag(const LevelDag& dag, const Grid& grid, const std::string& path);

// `file` must outlive the graph. Any other file is an Error (kBadInput).
std::unique_ptr<NodeGraph> read_hashdag(const File& file);

}  // namespace svdag
