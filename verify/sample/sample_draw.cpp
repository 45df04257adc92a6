// Draws bricks from a DAG, and combines the draws from file and scene.
#include <bit>

#include "io/dag/write/node_starts.h"
#include "streaming/error.h"
#include "verify/sample/sample.h"

namespace svdag {
namespace {

// For every inner node, the number of occupied bricks of the grid below it.
class BrickCounts {
 public:
  explicit BrickCounts(const DagView& dag) : dag_(dag) {
    for (uint32_t level = 0; level < dag.brick_level(); ++level)
      levels_.push_back({node_starts(dag, level, &budget_), {}});
    for (uint32_t level = dag.brick_level(); level-- > 0;) {
      Level& l = levels_[level];
      l.bricks.resize(l.starts.count());
      for (uint64_t index = 0, node = 0; node < l.bricks.size(); ++node) {
        dag_for_children(dag, level, uint32_t(index),
                         [&](unsigned, uint32_t child) { l.bricks[node] += of(level + 1, child); });
        index = dag_next(dag, level, index);
      }
    }
  }

  uint64_t of(uint32_t level, uint32_t node) const {
    if (level == dag_.brick_level()) return 1;
    return levels_[level].bricks[levels_[level].starts.rank(node)];
  }

 private:
  struct Level {
    RankBitmap starts;
    std::vector<uint64_t> bricks;
  };
  const DagView& dag_;
  MemoryBudget budget_;
  std::vector<Level> levels_;
};

}  // namespace

std::vector<uint64_t> sample_dag(const DagView& dag, uint64_t count, Random& random) {
  std::vector<uint64_t> codes;
  if (dag.empty()) return codes;
  const BrickCounts counts(dag);
  for (uint64_t i = 0; i < count; ++i) {
    uint64_t rest = random.below(counts.of(0, 0)), code = 0;
    uint32_t node = 0;
    for (uint32_t level = 0; level < dag.brick_level(); ++level) {
      for (unsigned c = 0; c < 8; ++c) {
        const uint32_t child = dag_child(dag, level, node, c);
        if (child == kNoChild) continue;
        const uint64_t bricks = counts.of(level + 1, child);
        if (rest < bricks) {
          code = code << 3 | c;
          node = child;
          break;
        }
        rest -= bricks;
      }
    }
    codes.push_back(code);
  }
  return codes;
}

std::vector<uint64_t> BrickDraw::all() const {
  std::vector<uint64_t> all = scene.all();
  all.insert(all.end(), file.begin(), file.end());
  all.insert(all.end(), anywhere.begin(), anywhere.end());
  return all;
}

BrickDraw draw_bricks(const Scene& scene, const DagView& dag, const Grid& grid, Rule rule,
                      uint64_t count, uint64_t seed) {
  Random random(seed);
  BrickDraw draw;
  draw.scene = draw_scene(scene, grid, count - count / 2, random);
  draw.file = sample_dag(dag, count - draw.scene.all().size(), random);
  for (uint64_t i = 0; is_solid(rule) && !grid.selection.empty() && i < count; ++i) {
    LatticePoint voxel;
    for (int a = 0; a < 3; ++a) {
      const int64_t side = grid.selection.max[a] - grid.selection.min[a];
      voxel[a] = grid.selection.min[a] + int64_t(random.below(uint64_t(side)));
    }
    draw.anywhere.push_back(cell_code(voxel >> int64_t(2)));
  }
  return draw;
}

void fail_untested() {
  fail_usage(
      "--sample: no brick to draw: the file has no voxels, and no triangle was found in its grid: "
      "omit --sample to compare all bricks");
}

}  // namespace svdag
