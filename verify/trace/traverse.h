// The one traversal kernel: the closest voxel along a ray, front to back through the DAG.
//
// Idea: Laine and Karras 2010, reduced to what a DAG needs. Coordinates are voxels. A ray is cut by
// the planes x = i, y = j, z = k at times t = (i - origin) / direction; a stack holds the node of
// each level. Inside a node the middle planes order its children; the child at time t follows from
// which middle planes have been passed, its exit is the next plane to come. Bricks are two more
// levels, whose "nodes" are the u64 and one of its bytes, so nothing is special below.
//
// Exactness: cell corners are integers and every time is computed from an integer plane by one
// subtraction and one multiplication in double, never by stepping, so errors do not add up: a hit
// at 1M^3 is off by 2^-32 voxel at most. All planes of a ray use the same expression, so times
// compare consistently and t strictly grows: the loop ends and no cell between is skipped.
// Rejected: floats in [1, 2) (23 bits are too few beyond 8K^3), a digital differential analyser
// voxel by voxel (cannot skip empty space).
//
// Depends on dag_view.h alone, for host and CUDA. Pointers are trusted: DagFile::open proved them.
#pragma once

#include "io/dag/dag_view.h"

namespace svdag {

struct Vec3 {
  double v[3];
  SVDAG_HD double operator[](int a) const { return v[a]; }
  SVDAG_HD double& operator[](int a) { return v[a]; }
};

struct Ray {
  Vec3 origin;     // in voxels
  Vec3 direction;  // any length but zero; t is measured in it
};

struct Hit {
  bool found = false;
  double t = 0;  // where the ray enters the voxel (0 if it starts inside)
  uint32_t voxel[3] = {};
  int axis = 0;  // the voxel's face that was entered is across this axis
};

// A component of the direction that is (nearly) zero is replaced by this fraction of the largest:
// over the diagonal of 1M^3 voxels the ray then moves by 2^-40 voxel, and no time is infinite.
constexpr double kTinySlope = 0x1p-61;

class Traversal {
 public:
  SVDAG_HD Traversal(const DagView& dag, const Ray& ray) : dag_(dag) {
    double largest = 0;
    for (int a = 0; a < 3; ++a) {
      const double size = ray.direction[a] < 0 ? -ray.direction[a] : ray.direction[a];
      largest = size > largest ? size : largest;
    }
    for (int a = 0; a < 3; ++a) {
      double d = ray.direction[a];
      const double tiny = kTinySlope * largest;
      if (d < tiny && d > -tiny) d = d < 0 ? -tiny : tiny;
      origin_[a] = ray.origin[a];
      inverse_[a] = 1 / d;
    }
  }

  // The first set voxel the ray meets at 0 <= t <= t_end.
  SVDAG_HD Hit closest(double t_end) {
    Hit hit;
    if (dag_.empty() || !enter_grid(t_end)) return hit;
    uint32_t level = 0;
    for (;;) {
      const Step step = next_child(level);
      uint64_t child;
      if (child_of(level, step.child, &child)) {
        if (level + 1 == dag_.levels) {
          report(step, &hit);
          return hit;
        }
        push(++level, child, step);
        continue;
      }
      t_ = step.exit;
      while (t_ >= stack_[level].exit) {
        if (level == 0) return hit;
        --level;
      }
    }
  }

 private:
  struct Frame {
    uint64_t node;  // word index; at the brick level the brick, below it one byte of the brick
    double exit;
    uint32_t corner[3];
  };
  struct Step {
    unsigned child;
    double exit;
    uint32_t corner[3];
  };

  SVDAG_HD double time(int axis, uint32_t plane) const {
    return (double(plane) - origin_[axis]) * inverse_[axis];
  }

  SVDAG_HD bool enter_grid(double t_end) {
    const uint32_t n = dag_.resolution();
    double enter = 0, exit = t_end;
    for (int a = 0; a < 3; ++a) {
      const bool forward = inverse_[a] > 0;
      const double in = time(a, forward ? 0 : n), out = time(a, forward ? n : 0);
      enter = in > enter ? in : enter;
      exit = out < exit ? out : exit;
    }
    if (!(enter < exit)) return false;
    t_ = enter;
    stack_[0] = {0, exit, {0, 0, 0}};
    return true;
  }

  // The child of the top frame in which the ray is just after time t_, and when it leaves that.
  SVDAG_HD Step next_child(uint32_t level) const {
    const Frame& frame = stack_[level];
    const uint32_t half = 1U << (dag_.levels - 1 - level);
    Step step{0, frame.exit, {}};
    for (int a = 0; a < 3; ++a) {
      const uint32_t middle = frame.corner[a] + half;
      const double t = time(a, middle);
      const bool passed = t_ >= t;
      if (!passed && t < step.exit) step.exit = t;
      const bool upper = passed == (inverse_[a] > 0);
      step.corner[a] = upper ? middle : frame.corner[a];
      step.child = step.child << 1 | unsigned(upper);
    }
    return step;
  }

  // Whether child c is there. A byte of a brick is a node of 2^3; a set bit in it is a voxel.
  SVDAG_HD bool child_of(uint32_t level, unsigned c, uint64_t* child) const {
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

  SVDAG_HD void push(uint32_t level, uint64_t node, const Step& step) {
    Frame& frame = stack_[level];
    frame.node = node;
    frame.exit = step.exit;
    for (int a = 0; a < 3; ++a) frame.corner[a] = step.corner[a];
  }

  // The face is across the axis whose near plane was passed last.
  SVDAG_HD void report(const Step& step, Hit* hit) const {
    hit->found = true;
    hit->t = t_;
    double last = 0;
    for (int a = 0; a < 3; ++a) {
      hit->voxel[a] = step.corner[a];
      const double near = time(a, step.corner[a] + (inverse_[a] > 0 ? 0U : 1U));
      if (a == 0 || near > last) {
        last = near;
        hit->axis = a;
      }
    }
  }

  const DagView& dag_;
  Vec3 origin_, inverse_;
  double t_ = 0;
  Frame stack_[kMaxSections + 2];
};

SVDAG_HD inline Hit trace_closest(const DagView& dag, const Ray& ray, double t_end) {
  return Traversal(dag, ray).closest(t_end);
}

}  // namespace svdag
