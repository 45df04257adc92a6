// Reader and writer of the DAG files of HashDAG and its successors (GPU-SVDAG-Editing, VkHashDAG):
// NAME{N/1024}k.basic_dag.dag.bin.
//
// Layout: box minimum and maximum (3 x f64 each), u32 levels = log2 N, u64 number of words, words.
// The root is at word 0. An inner node is its child mask (low 8 bits; the upper 24 hold colours)
// followed by the absolute word index of each child, in ascending child order. A leaf, at level
// L-2, is a brick in two words, the low word first. Children and bits are numbered as ours. The
// file name is part of the format: the programs derive it from the depth they were compiled for, at
// most 17.
//
// Colours are in a second file, NAME{N/1024}k.basic_dag.uncompressed_colors.bin, one for each
// voxel in depth-first order: u32 number T of top levels; u64 count and as many u64, the voxels
// below nodes of the top levels; u64 count and as many u32, the colours 0xAABBGGRR, opaque. The
// upper 24 bits of a mask are then the number of voxels below the node, or in levels 0 .. T-1 the
// number of an element of that list. So a reader finds the colour of a voxel by the voxels before
// it, as far as its 32 bits reach. Without colours the upper bits are zero here.
#pragma once

#include <memory>
#include <string>

#include "io/dag/graph/node_graph.h"
#include "io/formats/dags/whole_dag.h"
#include "streaming/spill/work_array.h"

namespace svdag {

// The file name that the programs expect for `path` = DIR/NAME; `path` itself if it already has the
// ending. Grids below 1K have no such name: Error (kUsage).
std::string hashdag_path(const std::string& path, int levels);

// More than 2^17 voxels per axis, or 2^32 - 1 words or more, are an Error (kUsage).
void write_hashdag(const WholeDag& dag, const std::string& path);

// The name of the colours beside the file `path`.
std::string hashdag_colours_path(const std::string& path);

// The same with the colours of `coloured` (VoxelColours); `dag` is a part of it. No voxel, more
// than 2^32, or 2^24 nodes of the top levels, are an Error (kUsage); too small a disk is one
// (kOutput), before a byte is written.
void write_coloured_hashdag(const WholeDag& dag, const DagFile& coloured, const std::string& path,
                            const WorkRoom& room);

// `file` must outlive the graph. Any other file is an Error (kBadInput).
std::unique_ptr<NodeGraph> read_hashdag(const File& file);

}  // namespace svdag
