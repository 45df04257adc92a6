#include "io/dag/dag_stats.h"

#include <algorithm>
#include <bit>
#include <bitset>
#include <numeric>

#include "streaming/error.h"

namespace svdag {
namespace {

std::vector<uint64_t> paths_to_root(const DagView& dag) {
  std::vector<uint64_t> paths(dag.index_end[0]);
  paths[0] = 1;
  return paths;
}

uint64_t total(const std::vector<uint64_t>& paths) {
  return std::accumulate(paths.begin(), paths.end(), uint64_t(0));
}

// Adds the paths of each node of `level` to its children; `paths` is by index.
std::vector<uint64_t> paths_below(const DagView& dag, uint32_t level,
                                  const std::vector<uint64_t>& paths) {
  const bool to_bricks = level + 1 == dag.brick_level();
  std::vector<uint64_t> below(to_bricks ? dag.brick_count : dag.index_end[level + 1]);
  for (uint64_t i = 0; i < dag.index_end[level]; i = dag_next(dag, level, i))
    dag_for_children(dag, level, uint32_t(i),
                     [&](unsigned, uint32_t child) { below[child] += paths[i]; });
  return below;
}

void count_bricks(const DagView& dag, const std::vector<uint64_t>& paths, DagStats* stats) {
  std::bitset<256> seen;
  for (uint64_t i = 0; i < dag.brick_count; ++i) {
    const uint64_t brick = dag.bricks[i];
    stats->voxels += paths[i] * uint64_t(std::popcount(brick));
    for (int b = 0; b < 64; b += 8) {
      const unsigned block = (brick >> b) & 0xffU;
      stats->blocks += block != 0 ? paths[i] : 0;
      seen.set(block);
    }
  }
  seen.reset(0);
  stats->unique_blocks = seen.count();
}

}  // namespace

uint64_t DagStats::svo_nodes() const {
  uint64_t sum = blocks;
  for (const LevelStats& level : levels) sum += level.svo_nodes;
  return sum;
}

uint64_t DagStats::dag_nodes() const {
  uint64_t sum = 0;
  for (const LevelStats& level : levels) sum += level.dag_nodes;
  return sum;
}

DagStats compute_stats(const DagFile& file) {
  const DagView& dag = file.view();
  DagStats stats;
  for (uint32_t k = 0; k <= dag.brick_level(); ++k) {
    const Section& section = file.header().sections[k];
    stats.levels.push_back({0, section.nodes, section.bytes});
  }
  if (dag.empty()) return stats;
  std::vector<uint64_t> paths = paths_to_root(dag);
  for (uint32_t level = 0; level <= dag.brick_level(); ++level) {
    stats.levels[level].svo_nodes = total(paths);
    if (level < dag.brick_level()) paths = paths_below(dag, level, paths);
  }
  count_bricks(dag, paths, &stats);
  return stats;
}

uint64_t count_level_voxels(const DagView& dag, uint32_t levels) {
  SVDAG_ASSERT(levels >= kMinLevels && levels <= dag.levels);
  if (dag.empty()) return 0;
  std::vector<uint64_t> paths = paths_to_root(dag);
  for (uint32_t level = 0; level < std::min(levels, dag.brick_level()); ++level)
    paths = paths_below(dag, level, paths);
  if (levels <= dag.brick_level()) return total(paths);
  DagStats stats;
  count_bricks(dag, paths, &stats);
  return levels < dag.levels ? stats.blocks : stats.voxels;
}

uint64_t level_counting_bytes(const DagView& dag, uint32_t levels) {
  uint64_t most = 0, above = 0;
  for (uint32_t level = 0; level <= std::min(levels, dag.brick_level()); ++level) {
    const uint64_t here = level < dag.brick_level() ? dag.index_end[level] : dag.brick_count;
    most = std::max(most, above + here);
    above = here;
  }
  return 8 * most;
}

}  // namespace svdag
