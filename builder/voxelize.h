// Second phase: each cell's triangles become the cell's sub-DAG, on all workers.
//
// A worker keeps one node table for all its cells, so what cells share is found at once. Which
// worker bakes which cell does not reach the output: numbers become ranks when the tables freeze.
#pragma once

#include <memory>
#include <vector>

#include "builder/cell_tree.h"
#include "builder/merge.h"
#include "builder/node_table.h"
#include "streaming/executor.h"
#include "streaming/progress.h"

namespace svdag {

struct VoxelizedCells {
  std::vector<std::unique_ptr<NodeTable>> tables;  // [worker]
  std::vector<CellRoot> roots;                     // rank: still the number in the table
  uint64_t cells = 0;                              // with at least one triangle near them
  uint64_t voxels = 0;
  DecisionCounts decisions;
  PlaneMemoCounts memo;
  std::vector<uint64_t> divided;  // cubes per level, inside the cells
};

VoxelizedCells voxelize(const CellTree& tree, const DescentConfig& config, MemoryBudget* budget,
                        Executor* executor, Progress* progress);

// Third phase: sorts the tables into runs and makes `rank` of the roots what its name says.
std::vector<Run> freeze(VoxelizedCells* cells, Executor* executor);

}  // namespace svdag
