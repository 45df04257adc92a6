// Drawing the bricks of a sample: from the DAG, and along the triangles.
#include <algorithm>
#include <bit>
#include <cmath>

#include "verify/node_index.h"
#include "verify/sample.h"

namespace svdag {
namespace {

// For every inner node, how many occupied bricks of the grid lie below it.
class BrickCounts {
 public:
  explicit BrickCounts(const DagView& dag) : dag_(dag), levels_(dag.brick_level()) {
    for (uint32_t level = dag.brick_level(); level-- > 0;) {
      Level& l = levels_[level];
      l.index = NodeIndex(dag.words[level], dag.word_count[level]);
      l.bricks.resize(l.index.nodes());
      const uint32_t* words = dag.words[level];
      for (uint64_t w = 0, node = 0; node < l.bricks.size(); ++node) {
        const int children = std::popcount(words[w] & 0xffU);
        for (int i = 1; i <= children; ++i) l.bricks[node] += of(level + 1, words[w + uint64_t(i)]);
        w += 1 + uint64_t(children);
      }
    }
  }

  uint64_t of(uint32_t level, uint32_t node) const {
    if (level == dag_.brick_level()) return 1;
    return levels_[level].bricks[levels_[level].index.rank(node)];
  }

 private:
  struct Level {
    NodeIndex index;
    std::vector<uint64_t> bricks;
  };
  const DagView& dag_;
  std::vector<Level> levels_;
};

double area(const LatticeTriangle& t) {
  const Point a(t.v[1] - t.v[0]), b(t.v[2] - t.v[0]);
  const Point n(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  return std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z);
}

// The brick of a random point of the triangle, moved by up to a voxel on each axis; false if that
// is outside the selection.
bool draw_brick(const LatticeTriangle& t, const Grid& grid, Random& random, uint64_t* code) {
  double a = random.unit(), b = random.unit();
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  const double side = double(int64_t(1) << grid.fraction());
  LatticePoint brick;
  for (int i = 0; i < 3; ++i) {
    const double q =
        double(t.v[0][i]) + a * double(t.v[1][i] - t.v[0][i]) + b * double(t.v[2][i] - t.v[0][i]);
    const double voxel = std::floor(q / side + 2 * random.unit() - 1);
    if (!(voxel >= double(grid.selection.min[i]) && voxel < double(grid.selection.max[i])))
      return false;
    brick[i] = int64_t(voxel) / kBrickSide;
  }
  *code = cell_code(brick);
  return true;
}

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

std::vector<uint64_t> sample_scene(const Scene& scene, const Grid& grid, uint64_t count,
                                   Random& random) {
  double total_area = 0;
  uint64_t triangles = 0;
  stream_snapped(scene, grid, [&](std::span<const LatticeTriangle> batch) {
    triangles += batch.size();
    for (const LatticeTriangle& t : batch) total_area += area(t);
  });
  std::vector<double> targets(count);
  for (double& target : targets) target = random.unit();
  std::sort(targets.begin(), targets.end());
  // Triangle after triangle takes the targets that its share of the unit interval covers.
  std::vector<uint64_t> codes;
  double covered = 0;
  size_t next = 0;
  stream_snapped(scene, grid, [&](std::span<const LatticeTriangle> batch) {
    for (const LatticeTriangle& t : batch) {
      const double by_area = total_area > 0 ? area(t) / total_area : 1 / double(triangles);
      covered += 0.5 * by_area + 0.5 / double(triangles);
      for (; next < count && targets[next] < covered; ++next) {
        uint64_t code;
        if (draw_brick(t, grid, random, &code)) codes.push_back(code);
      }
    }
  });
  return codes;
}

}  // namespace svdag
