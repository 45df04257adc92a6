// The pilot: estimates the cost of a bake, cell by cell, before it runs.
//
// A survey of the whole scene, a few levels coarser, takes a few per cent of the bake and shows how
// work is distributed. Then a few cells, drawn with probability proportional to their coarse cost,
// are surveyed at the grid's level, which shows how work grows. Growth cannot be extrapolated from
// coarse surveys: when the resolution doubles, a scan costs 1.3 times as much while its triangles
// are smaller than voxels, and more than 3 times when they are larger. Growth also varies within a
// scene (the plane memo handles floors, but not curtains), so the growth of a cell is estimated
// from the drawn cells nearest to it along the Morton curve.
//
// Work is additive, unique nodes are not: a larger part of a scene repeats itself more, at a rate
// that depends on the level. So the sample is evaluated in two sizes, all of it and a quarter, at
// both levels. n cells have u(n) ~ n^b unique nodes (Heaps' law), with an exponent b for each
// level; so the number of unique fine nodes is a power law of the number of unique coarse nodes.
// The two sizes determine the law, which is applied to the coarse survey of the whole scene or of a
// shard. No constant is fitted. Rejected: one ratio for all cells (planes repeat their bricks:
// three times too many), and a power with a fitted exponent (off by half for either nodes or
// bricks).
#pragma once

#include "builder/farm/planner/balance.h"
#include "builder/farm/planner/growth.h"
#include "builder/farm/planner/predict.h"

namespace svdag {

struct PilotConfig {
  DescentConfig descent;
  size_t shards = 1;
  uint64_t table_bytes = UINT64_MAX;  // as in SurveyConfig
  uint64_t triangle_bytes = UINT64_MAX;
};

struct Pilot {
  int cell_level = 0;
  std::vector<CellCost> cells;  // CPU seconds at the grid's level
  Work work;                    // of the whole scene, at the grid's level
  NodeCounts found;             // unique, of the whole scene
  int level = 0;                // of the coarse survey
  // From the coarse survey to the grid's level.
  Growth growth;
  PowerLaw nodes, bricks;  // of unique nodes and bricks
};

Pilot run_pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                const PilotConfig& config, MemoryBudget* budget);

// The work and the unique nodes of each shard. The sum of the nodes exceeds that of the whole
// scene, since shards have nodes in common.
std::vector<ShardWork> survey_shards(const Grid& grid, const std::vector<TriangleBin>& bins,
                                     SpillFile* file, const PilotConfig& config, const Pilot& pilot,
                                     const std::vector<CellRange>& shards, MemoryBudget* budget);

}  // namespace svdag
