#include "builder/farm/planner/survey.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "builder/reduce/run.h"
#include "builder/split/cell_tree.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kBatch = 4096;  // triangles read at once

// Rounds towards minus infinity. The error is less than a unit of the coarse lattice, far below a
// voxel.
// Without layers: those are not predicted.
LatticeTriangle shifted(LatticeTriangle triangle, int shift) {
  triangle.subject = kUnionSet;
  for (LatticePoint& v : triangle.v) {
    for (int a = 0; a < 3; ++a) v[a] >>= shift;
  }
  return triangle;
}

}  // namespace

Work& Work::operator+=(const Work& other) {
  divided += other.divided;
  computed += other.computed;
  return *this;
}

Work Work::operator-(const Work& other) const {
  return {divided - other.divided, computed - other.computed};
}

Work Work::operator*(double factor) const {
  return {divided * factor, computed * factor};
}

Grid coarser_grid(const Grid& grid, int level) {
  Grid coarse = grid;
  const int up = grid.levels - level;
  coarse.levels = level;
  coarse.voxel_size = std::ldexp(grid.voxel_size, up);
  for (int a = 0; a < 3; ++a) {
    coarse.selection.min[a] = grid.selection.min[a] >> up;
    coarse.selection.max[a] = -(-grid.selection.max[a] >> up);
  }
  return coarse;
}

// The node table, the descent that fills it, and their counts.
class Survey::Baker {
 public:
  Baker(const Grid& grid, const SurveyConfig& config, MemoryBudget* budget)
      : builder_(grid.levels, {.budget = budget,
                               .table_bytes = config.table_bytes,
                               .empty_table = [this] { empty_table(); }}),
        descent_(grid, config.descent, &builder_) {}

  void run(const Cube& cell, const TriangleList& list) { descent_.run(cell, list); }

  Work work() const {
    const DescentCounts& counts = descent_.counts();
    return {std::accumulate(counts.divided.begin(), counts.divided.end(), 0.0),
            double(counts.memo.computed)};
  }

  uint64_t bricks() {
    builder_.settle();
    return bricks_ + table().size(table().brick_level());
  }
  uint64_t nodes() {
    builder_.settle();
    uint64_t nodes = nodes_;
    for (int k = 0; k < table().brick_level(); ++k) nodes += table().size(k);
    return nodes;
  }

 private:
  NodeTable& table() { return *builder_.table(); }
  void empty_table() {
    bricks_ += table().size(table().brick_level());
    for (int k = 0; k < table().brick_level(); ++k) nodes_ += table().size(k);
    table().clear();
  }

  SubDagBuilder builder_;
  Descent descent_;
  uint64_t nodes_ = 0, bricks_ = 0;  // of the tables that were emptied
};

Survey::Survey(const Grid& grid, const SurveyConfig& config, MemoryBudget* budget)
    : fine_(grid), grid_(coarser_grid(grid, config.level)), config_(config), budget_(budget) {
  SVDAG_ASSERT(config.level <= grid.levels && config.cell_level <= config.level - 2);
  baker_ = std::make_unique<Baker>(grid_, config_, budget);
}

Survey::~Survey() = default;

bool Survey::count(SpillFile* file, const TriangleBin& bin, const CellFilter& filter,
                   const Visit& visit) {
  if (bin.triangles * PackedTriangles::kMinBytes > config_.triangle_bytes) return false;
  const int shift = fine_.levels + fine_.fraction() - grid_.levels - grid_.fraction();
  const Cube root = ancestor(bin.cube, std::min(bin.cube.level, config_.cell_level));
  CellTree tree(grid_, root, config_.cell_level, budget_);
  BinReader reader(file, bin, budget_);
  std::vector<LatticeTriangle> triangles;
  for (; reader.read(kBatch, &triangles); triangles.clear()) {
    check_interrupt();
    for (const LatticeTriangle& triangle : triangles) tree.add(shifted(triangle, shift));
    if (tree.bytes(1) > config_.triangle_bytes) return false;
  }
  tree.seal();
  CellCursor cursor(tree, config_.descent.overlap());
  for (const Cube& cell : tree.occupied_cells()) {
    const uint64_t code = morton(cell.coordinate);
    if (filter && !filter(code)) continue;
    const Work before = baker_->work();
    baker_->run(cell, cursor.list(cell));
    visit(code, baker_->work() - before);
    if (subset_ != nullptr && in_subset_(code)) subset_->baker_->run(cell, cursor.list(cell));
  }
  return true;
}

void Survey::add_subset(Survey* subset, CellFilter in_subset) {
  subset_ = subset;
  in_subset_ = std::move(in_subset);
}

uint64_t Survey::nodes() {
  return baker_->nodes();
}

uint64_t Survey::bricks() {
  return baker_->bricks();
}

}  // namespace svdag
