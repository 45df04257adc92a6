#include "builder/bake/voxelize.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>

#include "builder/descend/self_test.h"

namespace svdag {
namespace {

constexpr uint64_t kTasksPerWorker = 32;
constexpr uint64_t kMinDividedCell = 4096;  // cells with fewer triangles are not divided

}  // namespace

class Voxelizer::Worker {
 public:
  Worker(const Grid& grid, const VoxelizeConfig& config, MemoryBudget* budget)
      : config_(config),
        builder_(grid.levels, builder_config(config, budget)),
        descent_(grid, config.descent, &builder_, config.done) {}

  void begin(const CellTree& tree) {
    cursor_.emplace(tree, config_.descent.overlap());
    if (!tree.cuts().empty()) descent_.use(&tree.cuts());
  }
  void end() {
    cursor_.reset();
    descent_.use(nullptr);
  }
  void bake(const Cube& cell, const CellWindings* windings) {
    const LayerWindings at_cell = windings_at(cell, windings);
    const TriangleList& list = cursor_->list(cell);
    const std::optional<SubDagSets> sets = descent_.shared_sets(list, at_cell);
    if (config_.store == nullptr || !is_new(cell) || !sets || has_cuts(list) ||
        (!is_layer(sets->subject) && !config_.with_union))
      return descent_.run(cell, list, at_cell);
    const CellKey key = config_.store->key(cell, list, winding_of(at_cell, kUnionSet));
    if (!config_.store->take(key, cell, *sets)) bake_for_store(cell, list, at_cell, key);
  }
  void bake_untouched(const MortonRange& range, const CellWindings* windings) {
    if (windings == nullptr) return builder_.note_empty(range);
    for_each_cube(range, builder_.levels(), [&](const Cube& cube) {
      if (!is_done(morton_range(cube, builder_.levels())))
        descent_.run(cube, {}, windings->at(cube));
    });
  }
  bool is_done(const MortonRange& range) const {
    return config_.done != nullptr && config_.done->coverage(range) == MortonSet::Coverage::kAll;
  }
  NodeTable* table() { return builder_.table(); }
  void add_reduced(const Cube& cube, std::span<const SetsDag> dags) {
    descent_.add_reduced(cube, dags);
  }
  const Descent& descent() const { return descent_; }
  // Voxels set since the previous call; voxels of a run that was taken in between may be missing.
  uint64_t new_voxels() {
    const uint64_t before = std::exchange(seen_voxels_, builder_.voxels());
    return seen_voxels_ >= before ? seen_voxels_ - before : seen_voxels_;
  }

  BakedRun finish(bool spill) {
    builder_.settle();
    return take_run(spill);
  }

 private:
  SubDagBuilderConfig builder_config(const VoxelizeConfig& config, MemoryBudget* budget) {
    SubDagBuilderConfig own{.budget = budget, .table_bytes = config.table_bytes};
    own.max_seconds = config.max_seconds;
    own.with_union = config.with_union;
    if (config.scratch != nullptr) own.empty_table = [this] { config_.save(take_run(true)); };
    return own;
  }

  // Whether all of the cell is baked here: none of it is done, or left to others.
  bool is_new(const Cube& cell) const {
    return config_.done == nullptr || config_.done->coverage(morton_range(
                                          cell, builder_.levels())) == MortonSet::Coverage::kNone;
  }

  // Cubes in heavy cells are smaller than the cubes of `windings`.
  LayerWindings windings_at(const Cube& cube, const CellWindings* windings) {
    if (windings == nullptr) return {};
    const Cube known = ancestor(cube, std::min(cube.level, windings->level()));
    const LayerWindings at_known = windings->at(known);
    return known == cube ? at_known
                         : descent_.windings_at(cube, known, cursor_->list(known), at_known);
  }

  // If the table is emptied in the middle of a cell, the cell's nodes end up in two runs; such a
  // cell is not cached.
  void bake_for_store(const Cube& cell, const TriangleList& list, const LayerWindings& windings,
                      const CellKey& key) {
    const size_t first = builder_.roots().size(), runs = runs_;
    const uint64_t voxels = builder_.voxels();
    descent_.run(cell, list, windings);
    if (runs_ != runs) return;
    const size_t added = builder_.roots().size() - first;
    if (added == 0) return cells_.push_back({key, BakedCell::kNoRoot, 0});
    const SubDagRoot& last = builder_.roots().back();
    if (added == 1 && last.level == cell.level && last.morton == morton(cell.coordinate))
      cells_.push_back({key, first, builder_.voxels() - voxels});
  }

  BakedRun take_run(bool spill) {
    ++runs_;
    std::optional<SpillTarget> target;
    if (spill) target = new_target(config_.scratch, builder_.levels());
    BakedRun baked = builder_.take_run(target ? &*target : nullptr);
    baked.cells = std::exchange(cells_, {});
    return baked;
  }

  const VoxelizeConfig& config_;
  SubDagBuilder builder_;
  Descent descent_;
  std::optional<CellCursor> cursor_;
  std::vector<BakedCell> cells_;  // in the table
  size_t runs_ = 0;               // taken from the table
  uint64_t seen_voxels_ = 0;      // at the last new_voxels()
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

void Voxelizer::bake(CellTree* tree, const CellWindings* windings, const MortonRange& range,
                     Progress* progress) {
  const uint64_t share = tree->triangles() / (kTasksPerWorker * workers_.size());
  const std::vector<Cube> cells = tree->occupied_cells(std::max(share, kMinDividedCell));
  std::vector<MortonRange> ranges;
  std::array<std::atomic<size_t>, CellTree::kOctants + 1> left{};  // cells not baked, of an octant
  for (const Cube& cell : cells) {
    ranges.push_back(morton_range(cell, grid_.levels));
    ++left[tree->octant(cell)];
  }
  // Counted, but not refused: the tree exists because its share of the budget holds it.
  MemoryBudget::Reservation lists(budget_, 0);
  lists.try_resize(tree->prepared_bytes(workers_.size()));
  progress->phase("voxelize", cells.size(), "voxels");
  cells_ += cells.size();
  for (const auto& worker : workers_) worker->begin(*tree);
  if (cells.empty()) workers_[0]->bake_untouched(range, windings);
  executor_->for_each(cells.size(), [&](size_t w, size_t i) {
    Worker& worker = *workers_[w];
    if (i == 0) worker.bake_untouched({range.begin, ranges[0].begin}, windings);
    if (!worker.is_done(ranges[i])) worker.bake(cells[i], windings);
    const uint64_t next = i + 1 < cells.size() ? ranges[i + 1].begin : range.end;
    worker.bake_untouched({ranges[i].end, next}, windings);
    progress->advance(1, worker.new_voxels());
    const size_t octant = tree->octant(cells[i]);
    if (--left[octant] == 0) tree->release(octant);
  });
  for (const auto& worker : workers_) worker->end();
}

void Voxelizer::bake(const Cube& cube, const CellWindings* windings, const MortonRange& range,
                     const std::function<void(NodeTable*, std::vector<SetsDag>*)>& reduce) {
  ++cells_;
  const MortonRange own = morton_range(cube, grid_.levels);
  std::vector<SetsDag> dags;
  workers_[0]->bake_untouched({range.begin, own.begin}, windings);
  reduce(workers_[0]->table(), &dags);
  workers_[0]->add_reduced(cube, dags);
  workers_[0]->bake_untouched({own.end, range.end}, windings);
}

void Voxelizer::bake_untouched(const MortonRange& range, const CellWindings* windings) {
  workers_[0]->bake_untouched(range, windings);
}

std::vector<BakedRun> Voxelizer::finish(bool spill) {
  std::vector<BakedRun> runs(workers_.size());
  executor_->for_each(workers_.size(),
                      [&](size_t, size_t w) { runs[w] = workers_[w]->finish(spill); });
  return runs;
}

DescentCounts Voxelizer::counts() const {
  DescentCounts counts;
  for (const auto& worker : workers_) counts += worker->descent().counts();
  return counts;
}

}  // namespace svdag
