#include "verify/compare/dag_diff.h"

#include <algorithm>
#include <map>
#include <numeric>

namespace svdag {
namespace {

constexpr uint32_t kCellLevel = 6;

using Cell = std::array<uint32_t, 3>;

// Union-find (Tarjan 1975) with path halving.
size_t root_of(std::vector<size_t>* parents, size_t i) {
  while ((*parents)[i] != i) i = (*parents)[i] = (*parents)[(*parents)[i]];
  return i;
}

// Joins each cell with the neighbours before it in the map's order.
void join_neighbours(const std::map<Cell, size_t>& cells, std::vector<size_t>* parents) {
  for (const auto& [cell, index] : cells) {
    for (int n = 0; n < 27; ++n) {
      const Cell other{cell[0] + uint32_t(n / 9) - 1, cell[1] + uint32_t(n / 3 % 3) - 1,
                       cell[2] + uint32_t(n % 3) - 1};  // below 0 wraps, to no cell
      const auto found = other < cell ? cells.find(other) : cells.end();
      if (found != cells.end())
        (*parents)[root_of(parents, index)] = root_of(parents, found->second);
    }
  }
}

}  // namespace

std::vector<DiffCluster> diff_clusters(DagDiff* diff) {
  const uint32_t level = std::min(kCellLevel, diff->levels() - 2);
  const int64_t side = int64_t(1) << (diff->levels() - level);
  std::map<Cell, size_t> cells;
  std::vector<DiffCluster> parts;
  diff->visit_cubes(level, [&](const Cell& cell, uint64_t only_a, uint64_t only_b) {
    cells.emplace(cell, parts.size());
    const LatticePoint min = LatticePoint(cell[0], cell[1], cell[2]) * side;
    parts.push_back({{min, min + side}, only_a, only_b});
  });
  std::vector<size_t> parents(parts.size());
  std::iota(parents.begin(), parents.end(), size_t(0));
  join_neighbours(cells, &parents);
  std::vector<DiffCluster> clusters;
  std::map<size_t, size_t> cluster_of;  // by root
  for (size_t i = 0; i < parts.size(); ++i) {
    const auto [at, is_new] = cluster_of.emplace(root_of(&parents, i), clusters.size());
    if (is_new) {
      clusters.push_back(parts[i]);
      continue;
    }
    DiffCluster& cluster = clusters[at->second];
    cluster.box = {glm::min(cluster.box.min, parts[i].box.min),
                   glm::max(cluster.box.max, parts[i].box.max)};
    cluster.only_a += parts[i].only_a;
    cluster.only_b += parts[i].only_b;
  }
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const DiffCluster& a, const DiffCluster& b) {
                     return a.only_a + a.only_b > b.only_a + b.only_b;
                   });
  return clusters;
}

}  // namespace svdag
