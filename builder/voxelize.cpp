#include "builder/voxelize.h"

#include <algorithm>
#include <optional>

namespace svdag {
namespace {

constexpr uint64_t kTasksPerWorker = 32;
constexpr uint64_t kLightCell = 4096;  // triangles: not worth dividing

struct Worker {
  Worker(const CellTree& tree, const DescentConfig& config, NodeTable* table)
      : cursor(tree, config), descent(tree.grid(), config, table) {}
  CellCursor cursor;
  Descent descent;
};

}  // namespace

VoxelizedCells voxelize(const CellTree& tree, const DescentConfig& config, MemoryBudget* budget,
                        Executor* executor, Progress* progress) {
  const uint64_t share = tree.triangles() / (kTasksPerWorker * executor->workers());
  const std::vector<Cube> cells = tree.occupied_cells(std::max(share, kLightCell));
  progress->phase("voxelize", cells.size());
  VoxelizedCells result;
  result.cells = cells.size();
  for (size_t w = 0; w < executor->workers(); ++w)
    result.tables.push_back(std::make_unique<NodeTable>(tree.grid().levels, budget));
  std::vector<std::optional<Worker>> workers(executor->workers());
  executor->for_each(cells.size(), [&](size_t w, size_t i) {
    if (!workers[w]) workers[w].emplace(tree, config, result.tables[w].get());
    workers[w]->descent.run(cells[i], workers[w]->cursor.list(cells[i]));
    progress->advance();
  });
  for (size_t w = 0; w < workers.size(); ++w) {
    if (!workers[w]) continue;
    Descent& descent = workers[w]->descent;
    descent.finish();
    result.decisions += descent.decisions();
    result.memo += descent.memo();
    result.divided.resize(descent.divided().size());
    for (size_t k = 0; k < result.divided.size(); ++k) result.divided[k] += descent.divided()[k];
    for (const Descent::Root& root : descent.roots()) {
      result.roots.push_back({root.cube, uint32_t(w), root.dag.root - 1});
      result.voxels += root.dag.voxels;
    }
  }
  return result;
}

std::vector<Run> freeze(VoxelizedCells* cells, Executor* executor) {
  std::vector<Run> runs(cells->tables.size());
  std::vector<Ranks> ranks(runs.size());
  std::vector<std::vector<NodeNumber>> roots(runs.size());
  for (const CellRoot& root : cells->roots)
    roots[root.run].push_back({root.cell.level, root.rank});
  executor->for_each(runs.size(), [&](size_t, size_t r) {
    runs[r] = freeze(cells->tables[r].get(), roots[r], &ranks[r]);
    cells->tables[r].reset();
  });
  for (CellRoot& root : cells->roots)
    root.rank = ranks[root.run][size_t(root.cell.level)][root.rank];
  return runs;
}

}  // namespace svdag
