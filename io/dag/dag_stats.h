// Statistics of a DAG: the figures of the tables in the paper.
//
// The SVO is the tree before reduction. A DAG node represents as many SVO nodes as there are paths
// from the root to it; paths are counted top-down, one level at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "io/dag/dag_file.h"

namespace svdag {

struct LevelStats {
  uint64_t svo_nodes = 0;  // cubes of this level that contain a set voxel
  uint64_t dag_nodes = 0;  // unique nodes
  uint64_t bytes = 0;      // of the section
};

struct DagStats {
  std::vector<LevelStats> levels;  // 0 .. L-2; the last one counts bricks
  uint64_t blocks = 0;             // nonempty 2x2x2 blocks (level L-1 of the SVO)
  uint64_t unique_blocks = 0;      // distinct blocks: the leaves in the paper's convention
  uint64_t voxels = 0;

  // Nodes of the SVO with 2x2x2 leaves, as the paper counts (1 byte each).
  uint64_t svo_nodes() const;
  // Nodes of the DAG with bricks as leaves, as this file stores it.
  uint64_t dag_nodes() const;
  // Nodes of the DAG with 2x2x2 leaves, as the paper counts.
  uint64_t paper_dag_nodes() const { return dag_nodes() + unique_blocks; }
};

DagStats compute_stats(const DagFile& file);

// The number of set voxels of level `levels`, 3 .. L. One pass over the nodes above them.
uint64_t count_level_voxels(const DagView& dag, uint32_t levels);
// The temporary memory of count_level_voxels(), in bytes: 8 per index of two adjacent levels.
uint64_t level_counting_bytes(const DagView& dag, uint32_t levels);

}  // namespace svdag
