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
constexpr uint64_t kMinBins = 32, kMinBinsPerShard = 2;  // surveyed, of a large scene
constexpr uint64_t kLight = 8;       // a bin with less than a mean bin's triangles / kLight
constexpr double kRepetition = 0.9;  // the exponent of unique nodes
// Seconds per triangle of a bin too heavy to survey, if no others are left out (--calibrate of
// tests/bench/plan.py).
constexpr double kUnsurveyedTriangle = 6.07e-6;

// Unique nodes at the grid's level, if `coarse` were found by the coarse survey.
double extrapolate(double coarse, double sample_coarse, double sample_fine) {
  return sample_coarse > 0 ? sample_fine * std::pow(coarse / sample_coarse, kRepetition) : coarse;
}

uint64_t triangles_of(const std::vector<TriangleBin>& bins) {
  uint64_t triangles = 0;
  for (const TriangleBin& bin : bins) triangles += bin.triangles;
  return triangles;
}

// Coarse nodes for `all` triangles, if `counts` were found in `some`. They measure how much of the
// scene that is; extrapolate() says what repeats.
NodeCounts scaled(const NodeCounts& counts, uint64_t all, uint64_t some) {
  const double times = double(all) / double(std::max(some, uint64_t(1)));
  return {times * counts.nodes, times * counts.bricks};
}

bool contains(const CellRange& cells, uint64_t cell) {
  return cell >= cells.begin && cell < cells.end;
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
  const uint64_t triangles = triangles_of(bins);
  const uint64_t least = std::max(kMinBins, kMinBinsPerShard * shards);
  stride_ = size_t(std::clamp(triangles / config.pilot_triangles, uint64_t(1),
                              std::max(bins.size() / least, uint64_t(1))));
  light_ = triangles / (kLight * std::max(bins.size(), size_t(1)));
  while (level_ > min_level && triangles >> 2 * level_ >= kDense) --level_;
  cell_level_ = std::min(max_cell_level, shards > 256 ? kCellLevel + 1 : kCellLevel);
  while (survey_coarsely() * 4 * double(shards) >= 1 && cell_level_ < max_cell_level) ++cell_level_;
  draw();
  few_ = survey_sample(level_);
  fine_ = survey_sample(grid.levels);
  seconds_per_share_ = measured_rate();
  for (CellCost& cell : cells_) cell.cost *= seconds_per_share_;
  add_other_bins();
}

double Pilot::cost() const {
  double cost = 0;
  for (const CellCost& cell : cells_) cost += cell.cost;
  return cost;
}

// For how many bins the `number`-th stands; 0: it is not surveyed.
double Pilot::weight(const TriangleBin& bin, size_t number) const {
  if (bin.triangles < light_) return 1;
  return number % stride_ == 0 ? double(stride_) : 0;
}

// Returns the share of the most expensive cell.
double Pilot::survey_coarsely() {
  // A triangle in a cell costs as much as a cube at the grid's level, of which a surface meets 4
  // times as many per level.
  const double of_triangle = std::ldexp(1.0, -2 * (grid_.levels - level_));
  Survey survey = this->survey(level_);
  coarse_.clear();
  cells_.clear();
  surveyed_.assign(bins_.size(), false);
  uint64_t triangles = 0;
  for (size_t b = 0; b < bins_.size(); ++b) {
    const double weight = this->weight(bins_[b], b);
    if (weight == 0) continue;
    surveyed_[b] = survey.count(file_, bins_[b], {}, [&](uint64_t cell, const Survey::Cost& cost) {
      coarse_[cell].work += cost.work;
      coarse_[cell].share += cost.work + of_triangle * cost.triangles;
      coarse_[cell].bin = b;
      coarse_[cell].weight = weight;
    });
    triangles += surveyed_[b] ? bins_[b].triangles : 0;
  }
  coarse_found_ = scaled(survey.found(), triangles_of(bins_), triangles);
  double max = 0;
  work_ = shares_ = cell_count_ = 0;
  for (const auto& [code, cell] : coarse_) {
    cells_.push_back({code, cell.share});
    max = std::max(max, cell.share);
    work_ += cell.weight * cell.work;
    shares_ += cell.weight * cell.share;
    cell_count_ += cell.weight;
  }
  return shares_ > 0 ? max / shares_ : 0;
}

// Draws cells at equal intervals of their cumulative work.
void Pilot::draw() {
  const size_t count = std::clamp(size_t(kSampleShare * cell_count_), kMinSamples, kMaxSamples);
  const double interval = work_ / double(count);
  double before = 0, next = interval / 2;
  for (auto& [code, cell] : coarse_) {
    before += cell.weight * cell.work;
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
        [&](uint64_t cell, const Survey::Cost& cost) { sample.seconds[cell] += cost.seconds; });
  sample.found = survey.found();
  return sample;
}

// Since cells are drawn in proportion to work, the mean ratio of their seconds to it is that of all
// cells.
double Pilot::measured_rate() const {
  double sum = 0, draws = 0;
  for (const auto& [code, seconds] : fine_.seconds) {
    const CoarseCell& cell = coarse_.at(code);
    sum += cell.draws * seconds / cell.work;
    draws += cell.draws;
  }
  return draws > 0 ? sum / draws * work_ / shares_ : 1;
}

// The rate is that of the bins whose like were left out.
void Pilot::add_other_bins() {
  double cost = 0, triangles = 0;
  for (const auto& [code, cell] : coarse_)
    cost += cell.weight > 1 ? seconds_per_share_ * cell.share : 0;
  for (size_t b = 0; b < bins_.size(); ++b)
    triangles += surveyed_[b] && weight(bins_[b], b) > 1 ? double(bins_[b].triangles) : 0;
  const double rate = triangles > 0 ? cost / triangles : kUnsurveyedTriangle;
  for (size_t b = 0; b < bins_.size(); ++b) {
    if (surveyed_[b]) continue;
    cells_.push_back({bins_[b].range.begin >> 3 * (grid_.levels - cell_level_),
                      rate * double(bins_[b].triangles)});
  }
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
    for (const CellCost& cell : cells_) shard.cost += contains(cells, cell.cell) ? cell.cost : 0;
    Survey survey = this->survey(level_);
    uint64_t triangles = 0;
    size_t number = 0;
    for (const TriangleBin& bin : bins_of(bins_, cells, grid_.levels)) {
      add_triangles(bin, &shard);
      if (weight(bin, number++) > 0 &&
          survey.count(
              file_, bin, [&](uint64_t cell) { return contains(cells, cell); },
              [](uint64_t, const Survey::Cost&) {}))
        triangles += bin.triangles;
    }
    shard.found = fine_nodes(scaled(survey.found(), shard.triangles, triangles));
  }
  return works;
}

}  // namespace svdag
