#include "verify/trace/judge/nearest.h"

#include <algorithm>
#include <cmath>

namespace svdag {
namespace {

class Search {
 public:
  Search(const DagView& dag, const Vec3& point, double within)
      : dag_(dag), point_(point), best_square_(within * within) {}

  NearestVoxel run() {
    const uint32_t corner[3] = {0, 0, 0};
    if (!dag_.empty()) visit(0, 0, corner);
    best_.distance = std::sqrt(best_square_);
    return best_;
  }

 private:
  // Squared distance to the box of the centres of a cube's voxels.
  double square_to(const uint32_t corner[3], uint32_t side) const {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
      const double low = corner[a] + 0.5, high = corner[a] + side - 0.5;
      const double beyond = std::max({low - point_[a], point_[a] - high, 0.0});
      sum += beyond * beyond;
    }
    return sum;
  }

  // `node` is a word index; at the brick level it is the brick, below it one byte of the brick.
  void visit(uint32_t level, uint64_t node, const uint32_t corner[3]) {
    const uint32_t side = 1U << (dag_.levels - level);
    if (square_to(corner, side) >= best_square_) return;
    if (side == 1) {
      best_.found = true;
      best_square_ = square_to(corner, 1);
      std::copy(corner, corner + 3, best_.voxel);
      return;
    }
    const uint32_t half = side / 2;
    unsigned nearest = 0;  // the child nearest to the point
    for (int a = 0; a < 3; ++a) nearest = nearest << 1 | unsigned(point_[a] >= corner[a] + half);
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned c = nearest ^ i;
      uint64_t child = 0;
      if (!child_of(level, node, c, &child)) continue;
      const uint32_t at[3] = {corner[0] + (c >> 2) * half, corner[1] + (c >> 1 & 1) * half,
                              corner[2] + (c & 1) * half};
      visit(level + 1, child, at);
    }
  }

  bool child_of(uint32_t level, uint64_t node, unsigned c, uint64_t* child) const {
    if (level >= dag_.brick_level()) {
      *child = level == dag_.brick_level() ? node >> (8 * c) & 0xffU : node >> c & 1U;
      return *child != 0;
    }
    const uint32_t index = dag_child(dag_, level, uint32_t(node), c);
    if (index == kNoChild) return false;
    *child = level + 1 == dag_.brick_level() ? dag_.bricks[index] : index;
    return true;
  }

  const DagView& dag_;
  Vec3 point_;
  double best_square_;  // squared distance of the nearest centre so far
  NearestVoxel best_;
};

}  // namespace

NearestVoxel nearest_voxel(const DagView& dag, const Vec3& point, double within) {
  return Search(dag, point, within).run();
}

}  // namespace svdag
