#include "builder/farm/planner/survey.h"

#include <cmath>
#include <numeric>

#include "builder/split/cell_tree.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr size_t kSurveyBatch = 4096;  // triangles read at once

// Rounds towards minus infinity. The error is less than a unit of the coarse lattice, far below a
// voxel.
// Without layers: those are not predicted.
LatticeTriangle shifted(LatticeTriangle triangle, int shift) {
  triangle.subject = kUnionSet;
  triangle.cut = 0;
  for (LatticePoint& v : triangle.v) {
    for (int a = 0; a < 3; ++a) v[a] >>= shift;
  }
  return triangle;
}

NodeCounts counts_of(const NodeTable& table) {
  NodeCounts counts = {0, double(table.size(table.brick_level()))};
  for (int k = 0; k < table.brick_level(); ++k) counts.nodes += double(table.size(k));
  return counts;
}

}  // namespace

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

Survey::Survey(const Grid& grid, int level, int cell_level, const SurveyConfig& config,
               MemoryBudget* budget)
    : fine_(grid),
      grid_(coarser_grid(grid, level)),
      cell_level_(cell_level),
      config_(config),
      budget_(budget),
      builder_(level, {.budget = budget,
                       .table_bytes = config.table_bytes,
                       .empty_table =
                           [this] {
                             emptied_ += counts_of(*builder_.table());
                             builder_.table()->clear();
                           }}),
      descent_(grid_, config.descent, &builder_) {
  SVDAG_ASSERT(level <= grid.levels && cell_level <= level - 2);
}

double Survey::cpu() const {
  const DescentCounts& counts = descent_.counts();
  return descent_cpu(std::accumulate(counts.divided.begin(), counts.divided.end(), 0.0),
                     double(counts.memo.computed));
}

bool Survey::count(SpillFile* file, const TriangleBin& bin, const CellFilter& filter,
                   const Visit& visit) {
  if (bin.triangles * PackedTriangles::kMinBytes > config_.triangle_bytes) return false;
  const int shift = fine_.levels + fine_.fraction() - grid_.levels - grid_.fraction();
  const Cube root = ancestor(bin.cube, std::min(bin.cube.level, cell_level_));
  CellTree tree(grid_, root, cell_level_, budget_);
  BinReader reader(file, bin, budget_, SIZE_MAX);
  std::vector<LatticeTriangle> triangles;
  CutRecords cuts;  // estimated whole
  for (; reader.read(kSurveyBatch, &triangles, &cuts); triangles.clear(), cuts.clear()) {
    check_interrupt();
    for (const LatticeTriangle& triangle : triangles) tree.add(shifted(triangle, shift));
    if (tree.bytes(1) > config_.triangle_bytes) return false;
  }
  tree.seal();
  CellCursor cursor(tree, config_.descent.overlap());
  for (const Cube& cell : tree.occupied_cells()) {
    const uint64_t code = morton(cell.coordinate);
    if (filter && !filter(code)) continue;
    const double before = cpu();
    descent_.run(cell, cursor.list(cell));
    visit(code, cpu() - before);
  }
  return true;
}

NodeCounts Survey::found() {
  builder_.settle();
  NodeCounts found = emptied_;
  found += counts_of(*builder_.table());
  return found;
}

}  // namespace svdag
