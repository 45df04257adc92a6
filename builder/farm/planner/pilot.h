// The pilot: estimates the cost of a bake, cell by cell, before it runs.
//
// A survey of the whole scene, a few levels coarser, takes a few per cent of the bake and shows how
// work is distributed. Then a few cells, drawn with probability proportional to their coarse work,
// are surveyed at the grid's level and timed. Their mean ratio gives the cost of all, which cells
// share by their work and their triangles. It is measured: when the resolution doubles, a scan
// costs 1.3 times as much while its triangles are smaller than voxels, and more than 3 times when
// they are larger; and machines differ. So two plans of a scene are cut alike, but predict other
// seconds.
//
// Of scenes of tens of millions of triangles, only every n-th bin is surveyed, and all with few
// triangles, which may be large ones. A triangle of any other bin costs the mean of the surveyed:
// a bin is at most an eighth of a shard (builder/farm/planner/make_plan.cpp).
//
// Costs add up, unique nodes do not: a larger part of a scene repeats itself more, and fine nodes
// repeat themselves more than coarse ones. So the number of unique nodes is the sample's times a
// power of the ratio of unique coarse nodes, in the scene or in a shard to the sample (Heaps' law).
//
// Rejected for nodes: a power measured at two sizes of the sample, which predicts no better; the
// power 1 (15 to 40 % too many bytes at 64K^3); one power for the sum of nodes and bricks (bytes of
// a step off by 19 % instead of 5 %). Rejected for costs: a ratio for the neighbourhood of each
// cell along the Morton curve (p99 of the shards of real scenes 2.2 instead of 2.5, for a file
// more); the ratio of the sums, which large plane cells dominate (off by a factor of 2.6 instead
// of 1.6); cells drawn by cost instead of work (bytes of flat walls off by 8 instead of 4).
#pragma once

#include <map>
#include <vector>

#include "builder/farm/planner/balance.h"
#include "builder/farm/planner/survey.h"

namespace svdag {

class Pilot {
 public:
  // The triangles of `bins` are in `file`. The cells are small enough for `shards` equal shards.
  Pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
        const SurveyConfig& config, size_t shards, MemoryBudget* budget);

  int cell_level() const { return cell_level_; }
  // Non-empty cells; an estimate if not all bins were surveyed.
  uint64_t cell_count() const { return uint64_t(cell_count_); }
  // CPU seconds of voxelizing each non-empty cell at the grid's level, in Morton order. A bin that
  // was not surveyed counts as its first cell.
  const std::vector<CellCost>& cells() const { return cells_; }
  double cost() const;
  // Unique nodes of the whole scene.
  NodeCounts found() const { return fine_nodes(coarse_found_); }
  // The work and the unique nodes of each shard. Their sums exceed those of the whole scene: shards
  // have nodes in common, and each starts with an empty plane memo.
  std::vector<ShardWork> works_of(const std::vector<CellRange>& shards) const;

 private:
  struct CoarseCell {
    double work = 0;   // of its cubes
    double share = 0;  // of the costs of all: work with that of its triangles
    size_t bin = 0;
    double weight = 1;  // of the bin
    int draws = 0;
  };
  struct Sample {
    std::map<uint64_t, double> seconds;  // measured, by cell
    NodeCounts found;
  };

  Survey survey(int level) const { return {grid_, level, cell_level_, config_, budget_}; }
  double weight(const TriangleBin& bin, size_t number) const;
  double survey_coarsely();
  void draw();
  Sample survey_sample(int level) const;
  double measured_rate() const;
  void add_other_bins();
  NodeCounts fine_nodes(const NodeCounts& coarse) const;

  const Grid& grid_;
  const std::vector<TriangleBin>& bins_;
  SpillFile* file_;
  SurveyConfig config_;
  MemoryBudget* budget_;
  int level_ = 0;       // of the coarse survey
  size_t stride_ = 1;   // every stride_-th bin is surveyed
  uint64_t light_ = 0;  // and all with fewer triangles
  int cell_level_ = 0;
  std::map<uint64_t, CoarseCell> coarse_;          // by Morton code
  std::vector<bool> surveyed_;                     // by bin
  double cell_count_ = 0, work_ = 0, shares_ = 0;  // of all cells, the surveyed by weight
  NodeCounts coarse_found_;
  double seconds_per_share_ = 1;  // at the grid's level
  Sample few_, fine_;             // the drawn cells in the coarse survey and at the grid's level
  std::vector<CellCost> cells_;
};

}  // namespace svdag
