#include "builder/voxelize.h"

#include <optional>

namespace svdag {
namespace {

struct Worker {
  Worker(const CellTree& tree, const DescentConfig& config, NodeTable* table)
      : cursor(tree, config), descent(tree.grid(), config, table) {}
  CellCursor cursor;
  Descent descent;
};

}  // namespace

VoxelizedCells voxelize(const CellTree& tree, const DescentConfig& config, MemoryBudget* budget, Executor* executor,
                        Progress* progress) {
  const std::vector<Cube> cells = tree.occupied_cells();
  progress->phase("voxelize", cells.size());
  VoxelizedCells result;
  result.cells = cells.size();
  for (size_t w = 0; w < executor->workers(); ++w)
    result.tables.push_back(std::make_unique<NodeTable>(tree.grid().levels, budget));
  std::vector<std::optional<Worker>> workers(executor->workers());
  std::vector<SubDag> subdags(cells.size());
  std::vector<uint32_t> baked_by(cells.size());
  executor->for_each(cells.size(), [&](size_t w, size_t i) {
    if (!workers[w]) workers[w].emplace(tree, config, result.tables[w].get());
    subdags[i] = workers[w]->descent.run(cells[i], workers[w]->cursor.list(cells[i]));
    baked_by[i] = uint32_t(w);
    progress->advance();
  });
  for (const auto& worker : workers) {
    if (!worker) continue;
    result.decisions.asked += worker->descent.decisions().asked;
    result.decisions.exact += worker->descent.decisions().exact;
  }
  for (size_t i = 0; i < cells.size(); ++i) {
    if (subdags[i].root == 0) continue;
    result.roots.push_back({cells[i], baked_by[i], subdags[i].root - 1});
    result.voxels += subdags[i].voxels;
  }
  return result;
}

std::vector<Run> freeze(VoxelizedCells* cells, Executor* executor) {
  std::vector<Run> runs(cells->tables.size());
  std::vector<Ranks> ranks(runs.size());
  executor->for_each(runs.size(), [&](size_t, size_t r) {
    runs[r] = freeze(cells->tables[r].get(), &ranks[r]);
    cells->tables[r].reset();
  });
  for (CellRoot& root : cells->roots)
    root.rank = ranks[root.run][size_t(root.cell.level)][root.rank];
  return runs;
}

}  // namespace svdag
