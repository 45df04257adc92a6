// The plain traversal, the reference for verify/trace/kernel/traverse.h: a stack frame per level,
// one cube per step, and children found by comparing times with the middle planes' only.
#pragma once

#include <cstring>

#include "verify/trace/kernel/ray.h"

namespace svdag {

class PlainTraversal {
 public:
  PlainTraversal(const DagView& dag, const Ray& ray, const Cut& cut)
      : dag_(dag), ray_(ray, dag.resolution()), cut_(cut, ray, dag.levels) {}

  Hit closest(Span span) {
    Hit none;
    if (dag_.empty() || !ray_.clip(dag_.resolution(), &span)) return none;
    t_ = span.begin;
    stack_[0] = {0, span.end, {0, 0, 0}};
    uint32_t level = 0;
    if (cut_.solid(0, dag_.resolution(), t_)) return ray_.hit(dag_.levels, 0, stack_[0].corner, t_);
    for (;; ++none.steps) {
      const ChildStep step = next_child(level);
      uint64_t child;
      if (child_of(level, step.child, &child)) {
        if (cut_.solid(level + 1, double(1U << (dag_.levels - 1 - level)), t_)) {
          Hit hit = ray_.hit(dag_.levels, level + 1, step.corner, t_);
          hit.steps = none.steps;
          return hit;
        }
        push(++level, child, step);
        continue;
      }
      t_ = step.exit;
      while (t_ >= stack_[level].exit) {
        if (level == 0) return none;
        --level;
      }
    }
  }

 private:
  struct Frame {
    uint64_t node;  // word index; at the brick level it is the brick, below it a byte of the brick
    double exit;
    uint32_t corner[3];
  };
  struct ChildStep {
    unsigned child;
    double exit;
    uint32_t corner[3];
  };

  // The child of the top frame that contains the ray just after t_, and the time of its exit.
  ChildStep next_child(uint32_t level) const {
    const Frame& frame = stack_[level];
    const uint32_t half = 1U << (dag_.levels - 1 - level);
    ChildStep step{0, frame.exit, {}};
    for (int a = 0; a < 3; ++a) {
      const uint32_t middle = frame.corner[a] + half;
      const double t = ray_.time(a, middle);
      const bool passed = t_ >= t;
      if (!passed && t < step.exit) step.exit = t;
      step.corner[a] = passed ? middle : frame.corner[a];
      step.child = step.child << 1 | unsigned(passed);
    }
    step.child ^= ray_.flip;
    return step;
  }

  // Whether child c is occupied. A byte of a brick is a node of 2^3 voxels, its bits.
  bool child_of(uint32_t level, unsigned c, uint64_t* child) const {
    const uint64_t node = stack_[level].node;
    if (level >= dag_.brick_level()) {
      *child = level == dag_.brick_level() ? node >> (8 * c) & 0xffU : node >> c & 1U;
      return *child != 0;
    }
    const uint32_t index = dag_child(dag_, level, uint32_t(node), c);
    if (index == kNoChild) return false;
    *child = level + 1 == dag_.brick_level() ? dag_.bricks[index] : index;
    return true;
  }

  void push(uint32_t level, uint64_t node, const ChildStep& step) {
    Frame& frame = stack_[level];
    frame.node = node;
    frame.exit = step.exit;
    for (int a = 0; a < 3; ++a) frame.corner[a] = step.corner[a];
  }

  const DagView& dag_;
  MirroredRay ray_;
  CutOfRay cut_;
  double t_ = 0;
  Frame stack_[kMaxSections + 2];
};

// The first solid cube that the ray meets within `span`.
inline Hit plain_closest(const DagView& dag, const Ray& ray, const Span& span = {},
                         const Cut& cut = {}) {
  return PlainTraversal(dag, ray, cut).closest(span);
}

// Bitwise equality, except for the steps.
inline bool same(const Hit& a, const Hit& b) {
  bool equal = a.found == b.found && std::memcmp(&a.t, &b.t, sizeof a.t) == 0 &&
               a.level == b.level && a.axis == b.axis;
  for (int i = 0; i < 3; ++i) equal = equal && a.voxel[i] == b.voxel[i];
  return equal;
}

}  // namespace svdag
