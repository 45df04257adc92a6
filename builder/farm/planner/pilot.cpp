#include "builder/farm/planner/pilot.h"

#include <algorithm>
#include <map>
#include <set>

#include "builder/farm/plan/leaf_bins.h"

namespace svdag {
namespace {

constexpr int kLevelsCoarser = 4;
constexpr int kMinPilotLevel = 10;  // coarser surveys have too few bricks
constexpr int kMaxPilotLevel = 14;  // finer levels are estimated from the sample alone
constexpr int kCellLevel = 6;       // as in builder/bake/bake.cpp
constexpr int kMaxCellLevel = 8;
constexpr double kSampleShare = 0.03;  // of the cells
constexpr size_t kMaxSamples = 512, kMinSamples = 8;
constexpr int kSubsetStride = 4;  // every 4th drawn cell is also in the smaller sample
// Seconds per triangle of a bin that is too heavy to survey (tests/bench/plan.py --calibrate).
constexpr double kUnsurveyedTriangle = 7.27e-6;

SurveyConfig survey_config(const PilotConfig& config, int level, int cell_level) {
  SurveyConfig survey = {level, cell_level, config.descent, config.table_bytes,
                         config.triangle_bytes};
  survey.descent.memo_bytes = config.table_bytes / 8;
  return survey;
}

NodeCounts counts_of(Survey* survey) {
  return {double(survey->nodes()), double(survey->bricks())};
}

// The coarse survey: the work of each cell, and totals.
struct CoarseSurvey {
  std::map<uint64_t, Work> cells;
  std::map<uint64_t, size_t> bin_of;  // cell -> index of its bin
  std::vector<size_t> heavy;          // bins too heavy to survey
  Work work;
  NodeCounts found;
};

CoarseSurvey survey_coarsely(const Grid& grid, const std::vector<TriangleBin>& bins,
                             SpillFile* file, const SurveyConfig& config, MemoryBudget* budget) {
  Survey survey(grid, config, budget);
  CoarseSurvey coarse;
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

// Draws cells at equal intervals of the cumulative cost; returns the number of draws of each.
std::map<uint64_t, int> draw(const CoarseSurvey& coarse) {
  double all = 0;
  for (const auto& [cell, work] : coarse.cells) all += cpu_of(work);
  const size_t count =
      std::clamp(size_t(kSampleShare * double(coarse.cells.size())), kMinSamples, kMaxSamples);
  std::map<uint64_t, int> drawn;
  double before = 0, next = 0.5;
  for (const auto& [cell, work] : coarse.cells) {
    before += cpu_of(work) * double(count) / all;
    for (; before > next; next += 1) ++drawn[cell];
  }
  return drawn;
}

// Survey of the drawn cells at one level of detail, and unique nodes of all of them and of a
// subset, counted with separate tables.
struct Sample {
  NodeCounts found, found_in_subset;
  std::map<uint64_t, Work> cells;
};

Sample survey_sample(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                     const SurveyConfig& config, const CoarseSurvey& coarse,
                     const std::map<uint64_t, int>& drawn, MemoryBudget* budget) {
  Survey survey(grid, config, budget), subset_survey(grid, config, budget);
  std::set<size_t> sampled_bins;
  std::set<uint64_t> subset;
  int index = 0;
  for (const auto& [cell, times] : drawn) {
    sampled_bins.insert(coarse.bin_of.at(cell));
    if (index++ % kSubsetStride == 0) subset.insert(cell);
  }
  survey.add_subset(&subset_survey, [&](uint64_t cell) { return subset.contains(cell); });
  Sample sample;
  for (const size_t b : sampled_bins) {
    survey.count(
        file, bins[b], [&](uint64_t cell) { return drawn.contains(cell); },
        [&](uint64_t cell, const Work& work) { sample.cells[cell] += work; });
  }
  sample.found = counts_of(&survey);
  sample.found_in_subset = counts_of(&subset_survey);
  return sample;
}

double ratio(double fine, double coarse) {
  return coarse > 0 ? fine / coarse : 1;
}

}  // namespace

Pilot run_pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
                const PilotConfig& config, MemoryBudget* budget) {
  Pilot pilot;
  const int max_cell_level = std::max(0, std::min(kMaxCellLevel, grid.levels - 6));
  pilot.cell_level = std::min(max_cell_level, config.shards > 256 ? kCellLevel + 1 : kCellLevel);
  pilot.level = std::min(grid.levels,
                         std::clamp(grid.levels - kLevelsCoarser,
                                    std::max(kMinPilotLevel, max_cell_level + 3), kMaxPilotLevel));
  CoarseSurvey coarse;
  for (;; ++pilot.cell_level) {
    coarse = survey_coarsely(grid, bins, file, survey_config(config, pilot.level, pilot.cell_level),
                             budget);
    double max_cost = 0;
    for (const auto& [cell, work] : coarse.cells) max_cost = std::max(max_cost, cpu_of(work));
    const double share = cpu_of(coarse.work) / double(config.shards);
    if (max_cost < share / 4 || pilot.cell_level == max_cell_level) break;
  }
  const std::map<uint64_t, int> drawn = draw(coarse);
  const Sample fine_sample =
      survey_sample(grid, bins, file, survey_config(config, grid.levels, pilot.cell_level), coarse,
                    drawn, budget);
  const Sample coarse_sample =
      survey_sample(grid, bins, file, survey_config(config, pilot.level, pilot.cell_level), coarse,
                    drawn, budget);
  // Cells are drawn in proportion to cost, so the mean of their ratios estimates the ratio of the
  // costs of all cells between them.
  std::vector<Growth::DrawnCell> growths;
  for (const auto& [cell, work] : fine_sample.cells)
    growths.push_back({cell, ratio(cpu_of(work), cpu_of(coarse.cells.at(cell))), drawn.at(cell)});
  pilot.growth = Growth(growths);
  pilot.nodes = power_law(coarse_sample.found_in_subset.nodes, fine_sample.found_in_subset.nodes,
                          coarse_sample.found.nodes, fine_sample.found.nodes);
  pilot.bricks = power_law(coarse_sample.found_in_subset.bricks, fine_sample.found_in_subset.bricks,
                           coarse_sample.found.bricks, fine_sample.found.bricks);
  pilot.found = {pilot.nodes(coarse.found.nodes), pilot.bricks(coarse.found.bricks)};
  for (const auto& [cell, work] : coarse.cells) {
    const Work fine_work = work * pilot.growth.at(cell);
    pilot.cells.push_back({cell, cpu_of(fine_work)});
    pilot.work += fine_work;
  }
  for (const size_t b : coarse.heavy) {
    const uint64_t cell = bins[b].range.begin >> 3 * (grid.levels - pilot.cell_level);
    pilot.cells.push_back({cell, kUnsurveyedTriangle * double(bins[b].triangles)});
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
