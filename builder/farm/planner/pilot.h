// What a scene costs, cell by cell, before it is baked.
//
// The whole scene is surveyed a few levels coarser, which takes a few per cent of the bake: this
// tells how work is spread. Then a few cells, drawn with probability in proportion to their coarse
// cost, are surveyed as finely as they will be baked: this tells how much it grows. Growth cannot
// be extrapolated from coarse surveys: per doubling a scan costs 1.3 times as much while its
// triangles are smaller than voxels, and more than 3 times when they are not. Nor is it the same
// all over a scene (floors are answered by the plane memo, curtains are not): a cell grows as the
// drawn cells nearest to it do, along the Morton curve.
//
// Work adds up, unique nodes do not: a larger part of a scene repeats itself more, and finer voxels
// otherwise than coarse ones. So the sample is looked at in two sizes, all of it and a quarter, at
// both levels. Of n cells u(n) ~ n^b nodes are unique (Heaps' law), with an exponent for each
// level; then what is unique finely, as a function of what is unique coarsely, is a power law, too.
// The two sizes give it, and the coarse survey of the whole scene, or of a shard, is put in. No
// constant is in it. Rejected: the ratio of the sample, for all (planes repeat their bricks: three
// times too many), and its power by an exponent that was fitted (half right for nodes or bricks,
// never for both).
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
  std::vector<CellCost> cells;  // CPU seconds at the grid's own level
  Work work;                    // of the whole scene, at the grid's own level
  NodeCounts found;             // unique, of the whole scene
  int level = 0;                // of the coarse survey
  // From there to the grid's level.
  Growth growth;
  PowerLaw nodes, bricks;  // unique ones
};

Pilot run_pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                const PilotConfig& config, MemoryBudget* budget);

// What each of `shards` finds by itself: more in sum than the whole scene, for shards repeat each
// other.
std::vector<ShardWork> survey_shards(const Grid& grid, const std::vector<TriangleBin>& bins,
                                     SpillFile* file, const PilotConfig& config, const Pilot& pilot,
                                     const std::vector<CellRange>& shards, MemoryBudget* budget);

}  // namespace svdag
