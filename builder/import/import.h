// An import: voxels of another program in, one minimal `.svdag` out, the bytes that a bake of these
// voxels would give.
//
// DAGs are reduced as graphs (builder/import/graph_reduction.h). Lists of voxels are sorted by
// Morton code, out of core, and reduced brick by brick (builder/reduce/brick_reduction.h,
// builder/merge/merge.h); cubes that are set as a whole are put between them, each in one piece
// (builder/import/full_cubes.h).
#pragma once

#include <functional>
#include <string>

#include "io/dag/node_graph.h"
#include "io/voxel_source.h"
#include "streaming/file/input_watch.h"
#include "streaming/process/executor.h"

namespace svdag {

struct ImportConfig {
  std::string source;                  // the file that is read, for an Error
  const InputWatch* inputs = nullptr;  // checked before the output gets its name
  std::string output;
  int levels = 0;       // -r: L of the grid, where the file leaves it open; 0: as small as possible
  uint64_t memory = 0;  // --memory in bytes; 0: half of the machine
  std::string scratch;  // --scratch: the folder for scratch folders; empty: the output's
};

struct ImportReport {
  Grid grid;
  uint64_t voxels = 0;
  uint64_t nodes = 0;  // bricks included
  uint64_t file_bytes = 0;
  std::string content_hash;  // 32 hex digits
  int spilled = 0;           // files that what memory did not hold was sorted in
};

// Passes all voxels to the sinks and returns their placement.
using VoxelSource = std::function<GridPlacement(const VoxelSink&, const FullCubeSink&)>;

ImportReport import_graph(NodeGraph* graph, const ImportConfig& config, Executor* executor);
// Voxels outside of a grid of config.levels are an Error (kUsage). `count`: number of voxels, if
// known; more than the disk can sort are an Error (kOutput) before the first one is read.
ImportReport import_voxels(const VoxelSource& source, const ImportConfig& config,
                           Executor* executor, uint64_t count = 0);

}  // namespace svdag
