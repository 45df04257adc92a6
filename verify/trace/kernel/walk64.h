// The walk of one ray through a 64-tree; finds the same voxel as traverse.h.
//
// Idea: along a mirrored ray no coordinate decreases, so cells are met in ascending order of their
// numbers. The cells of a node that are both set and met (cells64.h) therefore form a queue in 64
// bits. A walk is a stack of such queues: a step fills the queue of one node, then moves to the
// first cell of the deepest non-empty queue. Empty space and leaving nodes cost nothing, and the
// only unpredictable branch is the last one, when a voxel is tested.
//
// A step ends with a prefetch of the address that the next one reads: a caller with several rays
// alternates between them (rays.cpp), so none waits for memory.
//
// Invariant: every met voxel is in a met cell of a met node, so the first voxel in the queues whose
// own six times say that it is met is the hit, entered at the latest of the near three. These are
// the bits of ray.h, whatever else is in the queues.
//
// For host and CUDA. No cuts: levels are taken two at a time here, and a cut may make cubes between
// them solid; cut rays are traced by traverse.h.
//
// Rejected: 12 or 16 rays in turns (at most 5 % faster, slower in bundles of 64), a loop over
// the rays for each step (3 to 10 % slower), beginning in the deepest node of the ray before
// (each climb is a mispredicted branch).
#pragma once

#include "verify/trace/kernel/cells64.h"

namespace svdag {

class Walk64 {
 public:
  // False if the ray misses the grid; else call step() until it returns false.
  SVDAG_HD bool start(const Tree64View& tree, const Ray& ray, Span span) {
    found_ = false;
    steps_ = 0;
    ray_ = MirroredRay(ray, tree.resolution());
    if (tree.empty() || !ray_.clip(tree.resolution(), &span)) return false;
    times_ = RayTimes(ray_, span);
    open_ = 0;
    for (double& c : origin_) c = 0;
    visit_ = {origin_, queues_[0].corner, tree.words, 0, 0};
    return true;
  }

  // The node that step() enters. The caller computes its cells (PlainCells, Avx2Cells).
  SVDAG_HD const RayTimes& times() const { return times_; }
  SVDAG_HD const Visit& visit() const { return visit_; }

  // Enters visit(), whose `cells` are set and possibly met. False at the end of the ray.
  SVDAG_HD bool step(const Tree64View& tree, uint64_t cells) {
    ++steps_;
    const bool brick = visit_.depth == tree.depth;
    if ((cells & (uint64_t(0) - uint64_t(brick))) != 0) [[unlikely]] {
      if (find_hit(cells)) return false;
      cells = 0;
    }
    Queue& queue = queues_[visit_.depth];
    queue.cells = cells;
    queue.node = visit_.node;
    open_ |= uint32_t(cells != 0) << visit_.depth;
    if (open_ == 0) [[unlikely]]
      return false;
    next_cell(tree);
    return true;
  }

  // The result, after step() returned false.
  SVDAG_HD bool found() const { return found_; }
  SVDAG_HD Hit hit(const Tree64View& tree) const {
    Hit hit;
    if (found_) hit = ray_.hit(tree.levels, tree.levels, voxel_, t_);
    hit.steps = steps_;
    return hit;
  }

 private:
  struct alignas(32) Queue {
    double corner[4];      // of the node
    uint64_t cells;        // not yet visited
    const uint64_t* node;  // its mask
  };

  // Moves to the first cell of the deepest non-empty queue.
  SVDAG_HD void next_cell(const Tree64View& tree) {
    const uint32_t depth = highest_bit(open_);
    Queue& queue = queues_[depth];
    const uint32_t cell = lowest_bit64(queue.cells);
    queue.cells &= queue.cells - 1;
    open_ ^= uint32_t(queue.cells == 0) << depth;
    const uint32_t rank = popcount64(*queue.node & ((uint64_t(1) << (cell ^ times_.flip)) - 1));
    // A brick is stored here, other children at their index; arithmetic instead of a branch.
    const uint64_t* const children = queue.node + 1;
    const uint64_t index = reinterpret_cast<const uint32_t*>(children)[rank];
    const uint64_t brick = uint64_t(children + rank - tree.words);
    const uint64_t bricks = uint64_t(0) - uint64_t(depth + 1 == tree.depth);
    visit_.node = tree.words + (index ^ ((index ^ brick) & bricks));
#if !defined(__CUDA_ARCH__)
    __builtin_prefetch(visit_.node);
    __builtin_prefetch(visit_.node + 8);  // the mask's children
#endif
    visit_.parent = queue.corner;
    visit_.corner = queues_[depth + 1].corner;
    visit_.cell = cell;
    visit_.depth = depth + 1;
  }

  // Finds the first of a brick's voxels that is met.
  SVDAG_HD bool find_hit(uint64_t voxels) {
    for (; voxels != 0; voxels &= voxels - 1) {
      double enter = times_.begin, exit = times_.end;
      for (int a = 0; a < 3; ++a) {
        voxel_[a] = uint32_t(visit_.corner[a]) + cell64_at(lowest_bit64(voxels), a);
        const double near = ray_.time(a, voxel_[a]), far = ray_.time(a, voxel_[a] + 1);
        enter = near > enter ? near : enter;
        exit = far < exit ? far : exit;
      }
      t_ = enter;
      found_ = enter < exit;
      if (found_) return true;
    }
    return false;
  }

  Queue queues_[kMaxDepth + 1];  // by depth; the last, of bricks, is always empty
  RayTimes times_;
  alignas(32) double origin_[4];
  Visit visit_;
  uint32_t open_;  // bit d: queues_[d] is not empty
  uint32_t steps_;
  bool found_;
  uint32_t voxel_[3];
  double t_;
  MirroredRay ray_;
};

}  // namespace svdag
