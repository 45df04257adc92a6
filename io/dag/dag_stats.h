// What a DAG contains: the figures of the paper's tables.
//
// Notation: the SVO is the tree before reduction; one DAG node represents as many SVO nodes as
// there are paths from the root to it, counted top-down, one level at a time.
#pragma once

#include <cstdint>
#include <vector>

#include "io/dag/dag_file.h"

namespace svdag {

struct LevelStats {
  uint64_t svo_nodes = 0;  // cubes of this level with a set voxel
  uint64_t dag_nodes = 0;  // unique ones
  uint64_t bytes = 0;      // of the section
};

struct DagStats {
  std::vector<LevelStats> levels;  // 0 .. L-2; the last one counts bricks
  uint64_t blocks = 0;             // nonempty 2x2x2 blocks (level L-1 of the SVO)
  uint64_t unique_blocks = 0;      // different ones: the leaves of the paper's convention
  uint64_t voxels = 0;

  // Nodes of the SVO with 2x2x2 leaves, as the paper counts (1 byte each).
  uint64_t svo_nodes() const;
  // Nodes of the DAG with bricks as leaves, as this file stores it.
  uint64_t dag_nodes() const;
  // Nodes of the DAG with 2x2x2 leaves, as the paper counts.
  uint64_t paper_dag_nodes() const { return dag_nodes() + unique_blocks; }
};

DagStats compute_stats(const DagFile& file);

// The number of voxels of level `levels`, 3 .. L: one pass over the nodes above them.
uint64_t count_level_voxels(const DagView& dag, uint32_t levels);
// The memory that it takes, in bytes: 8 for each word of two levels, one under the other.
uint64_t bytes_of_count(const DagView& dag, uint32_t levels);

}  // namespace svdag
