#include "builder/farm/planner/pilot.h"

#include <algorithm>
#include <map>
#include <set>

#include "builder/farm/plan/leaf_bins.h"

namespace svdag {
namespace {

constexpr int kLevelsCoarser = 4;
constexpr int kCoarsestPilot = 10;  // below, bricks are too few to tell
constexpr int kFinestPilot = 14;    // finer levels are estimated from the sample alone
constexpr int kCellLevel = 6;       // as builder/bake/bake.cpp
constexpr int kDeepestCells = 8;
constexpr double kSampleShare = 0.03;  // of the coarse cost
constexpr size_t kMaxSamples = 512, kFewestSamples = 8;
constexpr int kPart = 4;  // one drawn cell in so many is in the smaller sample, too
// Seconds per triangle of a bin that is too heavy to survey (tests/bench/plan.py --calibrate).
constexpr double kUnsurveyed = 7.05e-6;

SurveyConfig survey_config(const PilotConfig& config, int level, int cell_level) {
  SurveyConfig survey = {level, cell_level, config.descent, config.table_bytes,
                         config.triangle_bytes};
  survey.descent.memo_bytes = config.table_bytes / 8;
  return survey;
}

NodeCounts counts_of(Survey* survey) {
  return {double(survey->nodes()), double(survey->bricks())};
}

// The coarse survey: cost and work of each cell.
struct Coarse {
  std::map<uint64_t, Work> cells;
  std::map<uint64_t, size_t> bin_of;  // cell -> index of its bin
  std::vector<size_t> heavy;          // bins that were left out
  Work work;
  NodeCounts found;
};

Coarse survey_coarsely(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                       const SurveyConfig& config, MemoryBudget* budget) {
  Survey survey(grid, config, budget);
  Coarse coarse;
  for (size_t b = 0; b < bins.size(); ++b) {
    const bool counted = survey.count(file, bins[b], {}, [&](uint64_t cell, const Work& work) {
      coarse.cells[cell] += work;
      coarse.bin_of[cell] = b;
      coarse.work += work;
    });
    if (!counted) coarse.heavy.push_back(b);
  }
  coarse.found = counts_of(&survey);
  return coarse;
}

// Cells at equal distances along the sum of costs, and how often each was drawn.
std::map<uint64_t, int> draw(const Coarse& coarse) {
  double all = 0;
  for (const auto& [cell, work] : coarse.cells) all += cpu_of(work);
  const size_t count =
      std::clamp(size_t(kSampleShare * double(coarse.cells.size())), kFewestSamples, kMaxSamples);
  std::map<uint64_t, int> drawn;
  double before = 0, next = 0.5;
  for (const auto& [cell, work] : coarse.cells) {
    before += cpu_of(work) * double(count) / all;
    for (; before > next; next += 1) ++drawn[cell];
  }
  return drawn;
}

// The drawn cells at one level of detail, and a part of them, each with a table of its own.
struct Sample {
  NodeCounts found, found_in_part;
  std::map<uint64_t, Work> cells;
};

Sample survey_sample(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                     const SurveyConfig& config, const Coarse& coarse,
                     const std::map<uint64_t, int>& drawn, MemoryBudget* budget) {
  Survey survey(grid, config, budget), smaller(grid, config, budget);
  std::set<size_t> wanted_bins;
  std::set<uint64_t> part;
  int index = 0;
  for (const auto& [cell, times] : drawn) {
    wanted_bins.insert(coarse.bin_of.at(cell));
    if (index++ % kPart == 0) part.insert(cell);
  }
  survey.share_with(&smaller, [&](uint64_t cell) { return part.contains(cell); });
  Sample sample;
  for (const size_t b : wanted_bins) {
    survey.count(
        file, bins[b], [&](uint64_t cell) { return drawn.contains(cell); },
        [&](uint64_t cell, const Work& work) { sample.cells[cell] += work; });
  }
  sample.found = counts_of(&survey);
  sample.found_in_part = counts_of(&smaller);
  return sample;
}

double ratio(double fine, double coarse) {
  return coarse > 0 ? fine / coarse : 1;
}

}  // namespace

Pilot run_pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                const PilotConfig& config, MemoryBudget* budget) {
  Pilot pilot;
  const int finest_cells = std::max(0, std::min(kDeepestCells, grid.levels - 6));
  pilot.cell_level = std::min(finest_cells, config.shards > 256 ? kCellLevel + 1 : kCellLevel);
  pilot.level =
      std::min(grid.levels, std::clamp(grid.levels - kLevelsCoarser,
                                       std::max(kCoarsestPilot, finest_cells + 3), kFinestPilot));
  Coarse coarse;
  for (;; ++pilot.cell_level) {
    coarse = survey_coarsely(grid, bins, file, survey_config(config, pilot.level, pilot.cell_level),
                             budget);
    double dearest = 0;
    for (const auto& [cell, work] : coarse.cells) dearest = std::max(dearest, cpu_of(work));
    const double share = cpu_of(coarse.work) / double(config.shards);
    if (dearest < share / 4 || pilot.cell_level == finest_cells) break;
  }
  const std::map<uint64_t, int> drawn = draw(coarse);
  const Sample fine =
      survey_sample(grid, bins, file, survey_config(config, grid.levels, pilot.cell_level), coarse,
                    drawn, budget);
  const Sample same =
      survey_sample(grid, bins, file, survey_config(config, pilot.level, pilot.cell_level), coarse,
                    drawn, budget);
  // Cells are drawn in proportion to cost, so the mean of their ratios is that of all cells
  // between.
  std::vector<Growth::Drawn> growths;
  for (const auto& [cell, work] : fine.cells)
    growths.push_back({cell, ratio(cpu_of(work), cpu_of(coarse.cells.at(cell))), drawn.at(cell)});
  pilot.growth = Growth(growths);
  pilot.nodes = power_law(same.found_in_part.nodes, fine.found_in_part.nodes, same.found.nodes,
                          fine.found.nodes);
  pilot.bricks = power_law(same.found_in_part.bricks, fine.found_in_part.bricks, same.found.bricks,
                           fine.found.bricks);
  pilot.found = {pilot.nodes(coarse.found.nodes), pilot.bricks(coarse.found.bricks)};
  for (const auto& [cell, work] : coarse.cells) {
    const Work fine_work = work * pilot.growth.at(cell);
    pilot.cells.push_back({cell, cpu_of(fine_work)});
    pilot.work += fine_work;
  }
  for (const size_t b : coarse.heavy) {
    const uint64_t cell = bins[b].range.begin >> 3 * (grid.levels - pilot.cell_level);
    pilot.cells.push_back({cell, kUnsurveyed * double(bins[b].triangles)});
  }
  std::sort(pilot.cells.begin(), pilot.cells.end(),
            [](const CellCost& a, const CellCost& b) { return a.cell < b.cell; });
  return pilot;
}

std::vector<ShardWork> survey_shards(const Grid& grid, const std::vector<TriangleBin>& bins,
                                     SpillFile* file, const PilotConfig& config, const Pilot& pilot,
                                     const std::vector<CellRange>& shards, MemoryBudget* budget) {
  std::vector<ShardWork> works;
  for (const CellRange& cells : shards) {
    Survey survey(grid, survey_config(config, pilot.level, pilot.cell_level), budget);
    ShardWork shard;
    for (const TriangleBin& bin : bins_of(bins, cells, grid.levels)) {
      shard.triangles += bin.triangles;
      shard.heaviest_bin = std::max(shard.heaviest_bin, bin.triangles);
      survey.count(
          file, bin, [&](uint64_t cell) { return cell >= cells.begin && cell < cells.end; },
          [&](uint64_t cell, const Work& work) { shard.work += work * pilot.growth.at(cell); });
    }
    const NodeCounts found = counts_of(&survey);
    shard.found = {pilot.nodes(found.nodes), pilot.bricks(found.bricks)};
    works.push_back(shard);
  }
  return works;
}

}  // namespace svdag
