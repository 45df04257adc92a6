#include "io/dag/dag_stats.h"

#include <bit>
#include <bitset>

namespace svdag {
namespace {

// Adds the paths of each node of `level` to its children; `paths` is indexed by word.
std::vector<uint64_t> paths_below(const DagView& dag, uint32_t level,
                                  const std::vector<uint64_t>& paths) {
  const bool to_bricks = level + 1 == dag.brick_level();
  std::vector<uint64_t> below(to_bricks ? dag.brick_count : dag.word_count[level + 1]);
  for (uint64_t w = 0; w < dag.word_count[level];) {
    const int children = std::popcount(dag.words[level][w] & 0xffU);
    for (int i = 1; i <= children; ++i) below[dag.words[level][w + i]] += paths[w];
    w += 1 + children;
  }
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
  std::vector<uint64_t> paths(dag.word_count[0]);
  paths[0] = 1;
  for (uint32_t level = 0; level <= dag.brick_level(); ++level) {
    for (const uint64_t p : paths) stats.levels[level].svo_nodes += p;
    if (level < dag.brick_level()) paths = paths_below(dag, level, paths);
  }
  count_bricks(dag, paths, &stats);
  return stats;
}

}  // namespace svdag
