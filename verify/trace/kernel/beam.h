// Beams: one coarse traversal bounds the times at which a whole bundle of rays can hit anything.
//
// Idea: Laine and Karras 2010; Kaempe, Sintorn, Assarsson 2013. A beam contains rays whose origins
// are in a box O and whose directions are in a box D. At time t they are all in the box O + t D, so
// a cube can be met only while
//
//   O.low + t D.low <= cube.high  and  cube.low <= O.high + t D.high        on each axis
//
// These six inequalities are linear in t, so their solution is an interval. The descent follows
// occupied cubes with a non-empty interval, down to cubes no larger than the beam's width there.
// The result spans all their intervals. A tile of a picture (kTile x kTile pixels) is a beam with
// one origin. The shadow rays from a tile's surface to a light are a beam with t = 1 at the light;
// for them the end of the span matters as well as its begin.
//
// Conservative: cubes are grown by slack = 2^-38 * (|O| + N), a thousand times the rounding of
// ray.h (which places a plane to within 2^-48 * (|O| + N), replaced slopes included), and the
// result is widened by 2^-40 of itself. At the time of its hit, a ray is therefore inside a visited
// cube, or has met a cube that its cut makes solid, where the descent stops as well. So tracing
// with the beam's span gives the same hit, bit by bit. Rejected: the planes of a pyramid (tighter
// by up to sqrt(3), but only for rays with one origin); an image of coarse hits (not conservative).
//
// For host and CUDA.
#pragma once

#include "verify/trace/kernel/camera.h"

namespace svdag {

constexpr uint32_t kTile = 8;  // side of a tile, in pixels

class Beam {
 public:
  // Adds a ray. Directions may have any length, but t must have the same meaning for all rays.
  SVDAG_HD void add(const Ray& ray) {
    for (int a = 0; a < 3; ++a) {
      grow(ray.origin[a], &from_.min[a], &from_.max[a]);
      grow(ray.direction[a], &along_.min[a], &along_.max[a]);
    }
    const double size = length(ray.direction);
    longest_ = size > longest_ ? size : longest_;
    any_ = true;
  }
  SVDAG_HD bool empty() const { return !any_; }

  // The part of `span` outside which no ray of the beam meets a solid cube; begin >= end if none
  // does. If !both, only the begin is narrowed, which is faster.
  SVDAG_HD Span reach(const DagView& dag, const Span& span, const Cut& cut, bool both) const;

 private:
  struct Box {
    Vec3 min{{1e300, 1e300, 1e300}}, max{{-1e300, -1e300, -1e300}};
  };
  class Descent;

  SVDAG_HD static void grow(double value, double* low, double* high) {
    *low = value < *low ? value : *low;
    *high = value > *high ? value : *high;
  }

  Box from_, along_;
  double longest_ = 0;
  bool any_ = false;
};

// A descent, nearest children first, that skips cubes whose span is inside the one found so far.
class Beam::Descent {
 public:
  SVDAG_HD Descent(const Beam& beam, const DagView& dag, const Span& span, const Cut& cut,
                   bool both)
      : beam_(beam),
        dag_(dag),
        span_(span),
        cut_(cut),
        found_{1e300, both ? -1 : span.end},
        slack_(dag.resolution()) {
    for (int a = 0; a < 3; ++a) {
      const double low = beam.from_.min[a], high = beam.from_.max[a];
      const double reach = high > -low ? high : -low;
      slack_ = reach + dag.resolution() > slack_ ? reach + dag.resolution() : slack_;
      width_ = high - low > width_ ? high - low : width_;
      const double spread = beam.along_.max[a] - beam.along_.min[a];
      width_per_t_ = spread > width_per_t_ ? spread : width_per_t_;
      near_child_ |= unsigned(beam.along_.min[a] + beam.along_.max[a] < 0) << (2 - a);
    }
    slack_ *= 0x1p-38;
    cone_ = cut.spread > 0 ? cut.spread * beam.longest_ * (1 + 0x1p-40) : 0;
  }

  SVDAG_HD Span run() {
    if (!dag_.empty()) visit(0, 0, Corner{{0, 0, 0}});
    while (depth_ > 0) {
      const BeamEntry entry = stack_[--depth_];
      if (entry.met.begin < found_.begin || entry.met.end > found_.end)
        open(entry.level, entry.node, entry.corner);
    }
    if (!any_) return {span_.end, span_.end};
    const double early = found_.begin * (1 - 0x1p-40), late = found_.end * (1 + 0x1p-40) + 1e-290;
    return {early > span_.begin ? early : span_.begin, late < span_.end ? late : span_.end};
  }

 private:
  struct Corner {
    uint32_t v[3];
  };
  struct BeamEntry {
    uint32_t level, node;
    Corner corner;
    Span met;
  };

  // Narrows `met` to the times at which low <= value + t * slope.
  SVDAG_HD static void narrow(double low, double value, double slope, Span* met) {
    if (slope == 0) {
      if (value < low) met->end = -1;
      return;
    }
    const double t = (low - value) / slope;
    if (slope > 0) {
      met->begin = t > met->begin ? t : met->begin;
    } else {
      met->end = t < met->end ? t : met->end;
    }
  }

  SVDAG_HD void visit(uint32_t level, uint32_t node, const Corner& corner) {
    const double side = double(1U << (dag_.levels - level));
    Span met = span_;
    for (int a = 0; a < 3; ++a) {
      const double low = corner.v[a] - slack_, high = corner.v[a] + side + slack_;
      narrow(low, beam_.from_.max[a], beam_.along_.max[a], &met);
      narrow(-high, -beam_.from_.min[a], -beam_.along_.min[a], &met);
    }
    if (!(met.begin <= met.end) || (met.begin >= found_.begin && met.end <= found_.end)) return;
    if (level == dag_.brick_level() || level >= cut_.level || side <= cone_ * met.end ||
        side <= width_ + width_per_t_ * met.begin) {
      any_ = true;
      found_.begin = met.begin < found_.begin ? met.begin : found_.begin;
      found_.end = met.end > found_.end ? met.end : found_.end;
    } else {
      stack_[depth_++] = {level, node, corner, met};
    }
  }

  // Visits the children, farthest first, so that the nearest is popped first.
  SVDAG_HD void open(uint32_t level, uint32_t node, const Corner& corner) {
    const uint32_t half = 1U << (dag_.levels - 1 - level);
    for (unsigned i = 0; i < 8; ++i) {
      const unsigned c = (7 - i) ^ near_child_;
      const uint32_t child = dag_child(dag_, level, node, c);
      if (child == kNoChild) continue;
      visit(level + 1, child,
            {{corner.v[0] + (c >> 2) * half, corner.v[1] + (c >> 1 & 1) * half,
              corner.v[2] + (c & 1) * half}});
    }
  }

  const Beam& beam_;
  const DagView& dag_;
  const Span span_;
  const Cut cut_;
  Span found_;
  bool any_ = false;
  double slack_, width_ = 0, width_per_t_ = 0, cone_;
  unsigned near_child_ = 0;  // number of the child nearest to the origins
  uint32_t depth_ = 0;
  BeamEntry stack_[7 * kMaxSections + 1];
};

SVDAG_HD inline Span Beam::reach(const DagView& dag, const Span& span, const Cut& cut,
                                 bool both) const {
  return Descent(*this, dag, span, cut, both).run();
}

}  // namespace svdag
