#include "builder/bake/voxelize.h"

#include <algorithm>
#include <chrono>
#include <optional>

#include "builder/descend/self_test.h"

namespace svdag {
namespace {

using Clock = std::chrono::steady_clock;

constexpr uint64_t kTasksPerWorker = 32;
constexpr uint64_t kLightCell = 4096;      // triangles: not worth dividing
constexpr double kLeastSeconds = 1;        // of work: less of it is saved if it fills a batch
constexpr uint64_t kBytesPerPending = 48;  // a key not yet numbered, and its number

// Few enough keys that those which wait to be numbered take an eighth of a table's share.
size_t batch_of(uint64_t table_bytes) {
  return size_t(
      std::clamp<uint64_t>(table_bytes / 8 / kBytesPerPending, 1 << 10, NodeTable::kLargestBatch));
}

}  // namespace

class Voxelizer::Worker : public Spiller {
 public:
  Worker(const Grid& grid, const VoxelizeConfig& config, MemoryBudget* budget)
      : config_(config),
        table_(grid.levels, budget, batch_of(config.table_bytes)),
        descent_(grid, config.descent, &table_, config.done, this),
        last_(Clock::now()) {}

  void begin(const CellTree& tree) { cursor_.emplace(tree, config_.descent); }
  void end() { cursor_.reset(); }
  void bake(const Cube& cell) {
    const TriangleList& list = cursor_->list(cell);
    if (config_.store == nullptr || !is_new(cell)) return descent_.run(cell, list);
    const CellKey key = config_.store->key(cell, list);
    if (!config_.store->take(key, cell)) bake_for_store(cell, list, key);
  }
  void bake(const DenseCube& cube) { descent_.adopt(cube.cube(), cube.reduce(&table_)); }
  void note_empty(uint64_t begin, uint64_t end) { descent_.note_empty({begin, end}); }
  const Descent& descent() const { return descent_; }

  bool late(const NodeTable& table) override {
    return config_.scratch != nullptr && age() >= std::max(config_.seconds, kLeastSeconds) &&
           (table.pending() != 0 || freeze_bytes(table) != 0);
  }
  bool due(const NodeTable& table) override {
    if (config_.scratch == nullptr) return false;
    const uint64_t bytes = freeze_bytes(table);
    return bytes >= config_.table_bytes || (bytes != 0 && age() >= config_.seconds);
  }
  void spill(const Descent&) override {
    config_.save(freeze_table(true));
    last_ = Clock::now();
  }

  BakedRun finish(bool spill) {
    descent_.settle();
    return freeze_table(spill);
  }

 private:
  double age() const { return std::chrono::duration<double>(Clock::now() - last_).count(); }

  // Whether nothing of the cell is done, or left to others: else its content is not all of it.
  bool is_new(const Cube& cell) const {
    return config_.done == nullptr || config_.done->coverage(morton_range(cell, table_.levels())) ==
                                          MortonSet::Coverage::kNone;
  }

  // A cell in whose middle the table was emptied stands in two runs, and is of no use to others.
  void bake_for_store(const Cube& cell, const TriangleList& list, const CellKey& key) {
    const size_t roots = descent_.roots().size(), spills = spills_;
    const uint64_t voxels = descent_.voxels();
    descent_.run(cell, list);
    if (spills_ != spills) return;
    const size_t added = descent_.roots().size() - roots;
    if (added == 0) return cells_.push_back({key, BakedCell::kNoRoot, 0});
    if (added == 1 && descent_.roots().back().cube == cell)
      cells_.push_back({key, roots, descent_.voxels() - voxels});
  }

  BakedRun freeze_table(bool spill) {
    BakedRun baked;
    baked.cells = std::exchange(cells_, {});
    ++spills_;
    std::vector<NodeNumber> numbers;
    for (const Descent::Root& root : descent_.roots())
      numbers.push_back({root.cube.level, root.node - 1});
    std::optional<SpillTarget> target;
    if (spill)
      target = {config_.scratch->runs(), config_.scratch->new_streams(uint64_t(table_.levels()))};
    baked.run = freeze(&table_, numbers, target ? &*target : nullptr);
    for (size_t i = 0; i < numbers.size(); ++i)
      baked.roots.push_back(
          {morton(descent_.roots()[i].cube.coordinate), numbers[i].level, 0, numbers[i].number});
    baked.voxels = descent_.voxels();
    baked.finished = descent_.finished();
    return baked;
  }

  const VoxelizeConfig& config_;
  NodeTable table_;
  Descent descent_;
  std::optional<CellCursor> cursor_;
  Clock::time_point last_;        // when the table was emptied
  std::vector<BakedCell> cells_;  // in the table
  size_t spills_ = 0;
};

Voxelizer::Voxelizer(const Grid& grid, VoxelizeConfig config, MemoryBudget* budget,
                     Executor* executor)
    : grid_(grid), config_(std::move(config)), budget_(budget), executor_(executor) {
  self_test(config_.descent);
  config_.descent.memo_bytes = config_.table_bytes / 8;
  for (size_t w = 0; w < executor->workers(); ++w)
    workers_.push_back(std::make_unique<Worker>(grid, config_, budget));
}

Voxelizer::~Voxelizer() = default;

void Voxelizer::bake(const CellTree& tree, const MortonRange& range, Progress* progress) {
  const uint64_t share = tree.triangles() / (kTasksPerWorker * workers_.size());
  const std::vector<Cube> cells = tree.occupied_cells(std::max(share, kLightCell));
  std::vector<MortonRange> ranges;
  for (const Cube& cell : cells) ranges.push_back(morton_range(cell, grid_.levels));
  // Counted; beyond the limit it is nothing to end for: the tree was only made because its share
  // of the budget holds it.
  MemoryBudget::Reservation lists(budget_, 0);
  lists.try_resize(tree.prepared_bytes(workers_.size()));
  progress->phase("voxelize", cells.size());
  cells_ += cells.size();
  for (const auto& worker : workers_) worker->begin(tree);
  if (cells.empty()) workers_[0]->note_empty(range.begin, range.end);
  executor_->for_each(cells.size(), [&](size_t w, size_t i) {
    Worker& worker = *workers_[w];
    if (i == 0) worker.note_empty(range.begin, ranges[0].begin);
    if (config_.done == nullptr || config_.done->coverage(ranges[i]) != MortonSet::Coverage::kAll)
      worker.bake(cells[i]);
    worker.note_empty(ranges[i].end, i + 1 < cells.size() ? ranges[i + 1].begin : range.end);
    progress->advance();
  });
  for (const auto& worker : workers_) worker->end();
}

void Voxelizer::bake(const DenseCube& cube, const MortonRange& range) {
  ++cells_;
  const MortonRange own = morton_range(cube.cube(), grid_.levels);
  workers_[0]->note_empty(range.begin, own.begin);
  workers_[0]->bake(cube);
  workers_[0]->note_empty(own.end, range.end);
}

void Voxelizer::note_empty(const MortonRange& range) {
  workers_[0]->note_empty(range.begin, range.end);
}

std::vector<BakedRun> Voxelizer::finish(bool spill) {
  std::vector<BakedRun> runs(workers_.size());
  executor_->for_each(workers_.size(),
                      [&](size_t, size_t w) { runs[w] = workers_[w]->finish(spill); });
  return runs;
}

VoxelizeCounts Voxelizer::counts() const {
  VoxelizeCounts counts;
  counts.cells = cells_;
  counts.divided.resize(size_t(grid_.levels));
  for (const auto& worker : workers_) {
    const Descent& descent = worker->descent();
    counts.decisions += descent.decisions();
    counts.memo += descent.memo();
    for (size_t k = 0; k < counts.divided.size(); ++k) counts.divided[k] += descent.divided()[k];
  }
  return counts;
}

}  // namespace svdag
