// A survey counts the work of baking the cells of a scene at one level of detail.
//
// The planner surveys the whole scene coarsely, and a few cells at the level of the bake. Both use
// the descent of the bake, so whatever saves work there (empty space, the plane memo, repeated
// parts) also saves it in the survey. Rejected: counting triangles per cell (a wall of two
// triangles is expensive, a million triangles in one voxel are cheap).
#pragma once

#include <functional>
#include <vector>

#include "builder/descend/descend.h"
#include "builder/farm/planner/predict.h"
#include "builder/split/triangle_bins.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct SurveyConfig {
  DescentConfig descent;
  uint64_t table_bytes = UINT64_MAX;     // node table; when full, nodes may be counted repeatedly
  uint64_t triangle_bytes = UINT64_MAX;  // bins with more bytes of triangles are skipped
  uint64_t pilot_triangles = 8 << 20;    // of larger scenes a pilot surveys about so many
};

class Survey {
 public:
  using CellFilter = std::function<bool(uint64_t cell)>;
  // Of voxelizing a cell.
  struct Cost {
    double work;       // descent_work()
    double triangles;  // in the cell's list
    double seconds;    // CPU time that the survey took
  };
  using Visit = std::function<void(uint64_t cell, const Cost& cost)>;

  // The voxels of the survey are cubes of octree level `level` of the grid; cells, which are
  // counted separately, of `cell_level`, at most level - 2.
  Survey(const Grid& grid, int level, int cell_level, const SurveyConfig& config,
         MemoryBudget* budget);
  Survey(const Survey&) = delete;

  // Counts the cells of `bin` that pass `filter` (an empty filter passes all), in Morton order.
  // Returns false if the bin has too many triangles.
  bool count(SpillFile* file, const TriangleBin& bin, const CellFilter& filter, const Visit& visit);
  // Unique nodes so far.
  NodeCounts found();

 private:
  double work() const;

  Grid fine_;
  Grid grid_;  // `fine_` at the survey's level
  int cell_level_;
  SurveyConfig config_;
  MemoryBudget* budget_;
  SubDagBuilder builder_;
  Descent descent_;
  NodeCounts emptied_;  // of the tables that were emptied
};

// `grid` with voxels of octree level `level`; cubes keep their positions.
Grid coarser_grid(const Grid& grid, int level);

}  // namespace svdag
