#include "builder/farm/planner/pilot.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "builder/farm/plan/leaf_bins.h"

namespace svdag {
namespace {

constexpr int kLevelsCoarser = 4;
constexpr int kMinPilotLevel = 10;  // coarser surveys have too few bricks
constexpr int kMaxPilotLevel = 14;  // finer levels are estimated from the sample alone
// Triangles per 4^level: a coarser survey of a dense scan counts as much in less time.
constexpr uint64_t kDense = 16;
constexpr int kCellLevel = 6;  // as in builder/bake/bake.cpp
constexpr int kMaxCellLevel = 8;
constexpr double kSampleShare = 0.03;  // of the cells
constexpr size_t kMaxSamples = 512, kMinSamples = 8;
// Samples of larger scenes are drawn from so many triangles, but from no fewer bins than this.
constexpr uint64_t kSampledTriangles = uint64_t(8) << 20, kSampledBins = 32;
constexpr double kRepetition = 0.9;  // the exponent of unique nodes
// Seconds per triangle of a bin that is too heavy to survey (tests/bench/plan.py --calibrate).
constexpr double kUnsurveyedTriangle = 6.91e-6;

// Unique nodes at the grid's level, if `coarse` were found by the coarse survey.
double extrapolate(double coarse, double sample_coarse, double sample_fine) {
  return sample_coarse > 0 ? sample_fine * std::pow(coarse / sample_coarse, kRepetition) : coarse;
}

void add_triangles(const TriangleBin& bin, ShardWork* shard) {
  shard->triangles += bin.triangles;
  shard->heaviest_bin = std::max(shard->heaviest_bin, bin.triangles);
}

}  // namespace

Pilot::Pilot(const Grid& grid, const std::vector<TriangleBin>& bins, SpillFile* file,
             const SurveyConfig& config, size_t shards, MemoryBudget* budget)
    : grid_(grid), bins_(bins), file_(file), config_(config), budget_(budget) {
  const int max_cell_level = std::max(0, std::min(kMaxCellLevel, grid.levels - 6));
  const int min_level = std::max(kMinPilotLevel, max_cell_level + 3);
  level_ =
      std::min(grid.levels, std::clamp(grid.levels - kLevelsCoarser, min_level, kMaxPilotLevel));
  uint64_t triangles = 0;
  for (const TriangleBin& bin : bins) triangles += bin.triangles;
  stride_ = size_t(std::clamp(triangles / kSampledTriangles, uint64_t(1),
                              std::max(bins.size() / kSampledBins, uint64_t(1))));
  while (level_ > min_level && triangles >> 2 * level_ >= kDense) --level_;
  cell_level_ = std::min(max_cell_level, shards > 256 ? kCellLevel + 1 : kCellLevel);
  while (survey_coarsely() * 4 * double(shards) >= cost() && cell_level_ < max_cell_level)
    ++cell_level_;
  draw();
  few_ = survey_sample(level_);
  fine_ = survey_sample(grid.levels);
  growth_ = growth();
  for (CellCost& cell : cells_) cell.cost *= growth_;
  add_heavy_bins();
}

double Pilot::cost() const {
  double cost = 0;
  for (const CellCost& cell : cells_) cost += cell.cost;
  return cost;
}

// Returns the cost of the most expensive cell.
double Pilot::survey_coarsely() {
  Survey survey = this->survey(level_);
  coarse_.clear();
  heavy_.clear();
  cells_.clear();
  for (size_t b = 0; b < bins_.size(); ++b) {
    const bool counted = survey.count(file_, bins_[b], {}, [&](uint64_t cell, double cpu) {
      coarse_[cell].cpu += cpu;
      coarse_[cell].bin = b;
    });
    if (!counted) heavy_.push_back(b);
  }
  coarse_found_ = survey.found();
  double max = 0;
  for (const auto& [code, cell] : coarse_) {
    cells_.push_back({code, cell.cpu});
    max = std::max(max, cell.cpu);
  }
  return max;
}

// Draws cells of every stride_-th bin, at equal intervals of their cumulative cost.
void Pilot::draw() {
  double all = 0;
  for (const auto& [code, cell] : coarse_) all += cell.bin % stride_ == 0 ? cell.cpu : 0;
  const size_t count =
      std::clamp(size_t(kSampleShare * double(coarse_.size())), kMinSamples, kMaxSamples);
  const double interval = all / double(count);
  double before = 0, next = interval / 2;
  for (auto& [code, cell] : coarse_) {
    if (cell.bin % stride_ != 0) continue;
    before += cell.cpu;
    for (; before > next; next += interval) ++cell.draws;
  }
}

// Surveys the drawn cells.
Pilot::Sample Pilot::survey_sample(int level) const {
  Survey survey = this->survey(level);
  std::set<size_t> bins;
  for (const auto& [code, cell] : coarse_) {
    if (cell.draws > 0) bins.insert(cell.bin);
  }
  Sample sample;
  for (const size_t b : bins)
    survey.count(
        file_, bins_[b],
        [&](uint64_t cell) {
          const auto found = coarse_.find(cell);
          return found != coarse_.end() && found->second.draws > 0;
        },
        [&](uint64_t cell, double cpu) { sample.cpu[cell] += cpu; });
  sample.found = survey.found();
  return sample;
}

// The mean ratio of costs at the grid's level and in the coarse survey. Since cells are drawn in
// proportion to cost, it is also the ratio of the costs of all cells.
double Pilot::growth() const {
  double sum = 0, draws = 0;
  for (const auto& [code, cpu] : fine_.cpu) {
    const CoarseCell& cell = coarse_.at(code);
    sum += cell.draws * cpu / cell.cpu;
    draws += cell.draws;
  }
  return draws > 0 ? sum / draws : 1;
}

void Pilot::add_heavy_bins() {
  for (const size_t b : heavy_)
    cells_.push_back({bins_[b].range.begin >> 3 * (grid_.levels - cell_level_),
                      kUnsurveyedTriangle * double(bins_[b].triangles)});
  std::ranges::sort(cells_, {}, &CellCost::cell);
}

NodeCounts Pilot::fine_nodes(const NodeCounts& coarse) const {
  return {extrapolate(coarse.nodes, few_.found.nodes, fine_.found.nodes),
          extrapolate(coarse.bricks, few_.found.bricks, fine_.found.bricks)};
}

std::vector<ShardWork> Pilot::works_of(const std::vector<CellRange>& shards) const {
  if (shards.size() == 1) {  // the whole scene was surveyed
    ShardWork whole{.cost = cost(), .found = found()};
    for (const TriangleBin& bin : bins_) add_triangles(bin, &whole);
    return {whole};
  }
  std::vector<ShardWork> works;
  for (const CellRange& cells : shards) {
    ShardWork& shard = works.emplace_back();
    Survey survey = this->survey(level_);
    uint64_t surveyed = 0;  // triangles
    size_t next = 0;
    for (const TriangleBin& bin : bins_of(bins_, cells, grid_.levels)) {
      add_triangles(bin, &shard);
      if (next++ % stride_ != 0) continue;
      surveyed += bin.triangles;
      const bool counted = survey.count(
          file_, bin, [&](uint64_t cell) { return cell >= cells.begin && cell < cells.end; },
          [&](uint64_t, double cpu) { shard.cost += growth_ * cpu; });
      if (!counted) shard.cost += kUnsurveyedTriangle * double(bin.triangles);
    }
    const double times = double(shard.triangles) / double(std::max(surveyed, uint64_t(1)));
    shard.cost *= times;
    const NodeCounts coarse = survey.found();
    const double more = std::pow(times, kRepetition);
    shard.found = fine_nodes({more * coarse.nodes, more * coarse.bricks});
  }
  return works;
}

}  // namespace svdag
