#include "builder/farm/planner/survey.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <utility>

#include "builder/split/cell_tree.h"
#include "io/lattice.h"
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

// CPU time of this thread.
double thread_seconds() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

NodeCounts counts_of(const NodeTable& table) {
  NodeCounts counts = {0, double(table.size(table.brick_level()))};
  for (int k = 0; k < table.brick_level(); ++k) counts.nodes += double(table.size(k));
  return counts;
}

// Whether the triangle may meet a cell of `level` that passes: its box does, or has many cells.
bool may_meet(const LatticeTriangle& triangle, const Grid& grid, int level,
              const Survey::CellFilter& filter) {
  constexpr int64_t kManyCells = 64;
  const LatticeBox box = box_of(triangle);
  const int shift = grid.levels - level + grid.fraction();
  int64_t first[3], last[3], cells = 1;
  for (int a = 0; a < 3; ++a) {
    const int64_t end = (int64_t(1) << level) - 1;
    first[a] = std::clamp<int64_t>(first_touched(box.min[a], shift), 0, end);
    last[a] = std::clamp<int64_t>(last_touched(box.max[a], shift), 0, end);
    cells *= last[a] - first[a] + 1;
    if (cells > kManyCells) return true;
  }
  for (int64_t i = 0; i < cells; ++i) {
    const int64_t y = last[1] - first[1] + 1, z = last[2] - first[2] + 1;
    const LatticePoint cell(first[0] + i / (y * z), first[1] + i / z % y, first[2] + i % z);
    if (filter(morton(cell))) return true;
  }
  return false;
}

// Triangles of dense scans are much smaller than the voxels of a survey: one inside a voxel sets
// what all others inside it do. Remembers the newest voxel of each place in blocks of 16^3.
class InsideVoxels {
 public:
  explicit InsideVoxels(int fraction) : fraction_(fraction) {}

  // Whether the triangle is inside a voxel, off its faces, that is remembered already.
  bool repeats(const LatticeTriangle& triangle) {
    const LatticeBox box = box_of(triangle);
    LatticePoint voxel;
    for (int a = 0; a < 3; ++a) {
      voxel[a] = last_touched(box.max[a], fraction_);
      if (first_touched(box.min[a], fraction_) != voxel[a]) return false;
    }
    const size_t place = size_t(voxel.x & 15 | (voxel.y & 15) << 4 | (voxel.z & 15) << 8);
    return std::exchange(newest_[place], voxel) == voxel;
  }

 private:
  int fraction_;
  std::vector<LatticePoint> newest_ = std::vector<LatticePoint>(4096, LatticePoint(-1));
};

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

double Survey::work() const {
  const DescentCounts& counts = descent_.counts();
  return descent_work(std::accumulate(counts.divided.begin(), counts.divided.end(), 0.0),
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
  InsideVoxels inside(grid_.fraction());
  for (; reader.read(kSurveyBatch, &triangles, &cuts); triangles.clear(), cuts.clear()) {
    check_interrupt();
    for (const LatticeTriangle& triangle : triangles) {
      const LatticeTriangle coarse = shifted(triangle, shift);
      if (config_.descent.rule == Rule::kConservative && inside.repeats(coarse)) continue;
      if (!filter || may_meet(coarse, grid_, cell_level_, filter)) tree.add(coarse);
    }
    if (tree.bytes(1) > config_.triangle_bytes) return false;
  }
  tree.seal();
  CellCursor cursor(tree, config_.descent.overlap());
  for (const Cube& cell : tree.occupied_cells()) {
    const uint64_t code = morton(cell.coordinate);
    if (filter && !filter(code)) continue;
    const double before = work(), begin = thread_seconds();
    const TriangleList& list = cursor.list(cell);
    descent_.run(cell, list);
    visit(code, {work() - before, double(list.size()), thread_seconds() - begin});
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
