// What a scene costs, cell by cell, before it is baked.
//
// The whole scene is surveyed a few levels coarser, which takes a few per cent of the bake: this
// tells how work is spread. Then a few cells, drawn with probability in proportion to their coarse
// cost, are surveyed as finely as they will be baked: this tells how much it grows. Growth cannot
// be extrapolated from coarse surveys: per doubling a scan costs 1.3 times as much while its
// triangles are smaller than voxels, and more than 3 times when they are not.
#pragma once

#include "builder/farm/balance.h"
#include "builder/farm/predict.h"

namespace svdag {

struct PilotConfig {
  DescentConfig descent;
  size_t shards = 1;
  uint64_t table_bytes = UINT64_MAX;  // as in SurveyConfig
  uint64_t triangle_bytes = UINT64_MAX;
};

struct Pilot {
  int cell_level = 0;
  std::vector<CellCost> cells;  // CPU seconds at the grid's own level
  Work work;                    // of the whole scene, at the grid's own level
  NodeCounts found;             // unique, of the whole scene
  // For shards, see count_found().
  int level = 0;           // of the coarse survey
  double work_growth = 1;  // from the coarse survey to the grid's level
  NodeCounts growth;
};

Pilot run_pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                const PilotConfig& config, MemoryBudget* budget);

// What each of `shards` finds by itself: more in sum than the whole scene, for shards repeat each
// other.
std::vector<ShardWork> survey_shards(const Grid& grid, const std::vector<TriangleBin>& bins,
                                     SpillFile* file, const PilotConfig& config, const Pilot& pilot,
                                     const std::vector<CellRange>& shards, MemoryBudget* budget);

}  // namespace svdag
