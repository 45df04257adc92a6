// What a scene costs, cell by cell, before it is baked.
//
// The whole scene is surveyed a few levels coarser, which takes a few per cent of the bake: this
// tells how work is spread. Then a few cells, drawn with probability in proportion to their coarse
// cost, are surveyed as finely as they will be baked: this tells how much it grows. Growth cannot
// be extrapolated from coarse surveys: per doubling a scan costs 1.3 times as much while its
// triangles are smaller than voxels, and more than 3 times when they are not.
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

#include "builder/farm/balance.h"
#include "builder/farm/predict.h"

namespace svdag {

struct PilotConfig {
  DescentConfig descent;
  size_t shards = 1;
  uint64_t table_bytes = UINT64_MAX;  // as in SurveyConfig
  uint64_t triangle_bytes = UINT64_MAX;
};

// y = fine (x / coarse)^exponent
struct PowerLaw {
  double coarse = 1, fine = 1, exponent = 1;

  double operator()(double x) const;
};

// Through (quarter_x, quarter_y) and (x, y). The exponent is between 0 and 1, for finer voxels
// repeat themselves no less; 1 where the points are too near to each other to tell. Without a
// sample: y = x.
PowerLaw power_law(double quarter_x, double quarter_y, double x, double y);

struct Pilot {
  int cell_level = 0;
  std::vector<CellCost> cells;  // CPU seconds at the grid's own level
  Work work;                    // of the whole scene, at the grid's own level
  NodeCounts found;             // unique, of the whole scene
  // From the coarse survey to the grid's level.
  int level = 0;  // of the coarse survey
  double work_growth = 1;
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
