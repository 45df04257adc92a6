// Clipping of pictures: only the voxels in a box are visible, and where the box cuts through
// matter, the section is shown.
//
// The box has voxel planes, and a ray crosses them at the times of verify/trace/kernel/ray.h, the
// same by which the traversal selects cells. So the picture equals the one of a DAG without the
// voxels outside, exactly.
#pragma once

#include <optional>

#include "verify/trace/kernel/ray.h"

namespace svdag {

// Voxels min <= k < max on each axis.
struct ClipBox {
  uint32_t min[3];
  uint32_t max[3];
};

struct ClippedSpan {
  Span span;
  int entry = -1;  // axis of the plane through which the ray enters the box; -1: starts inside
};

// The part of `span` in the box; none if the ray misses it.
inline std::optional<ClippedSpan> clip(const ClipBox& box, const Ray& ray, uint32_t resolution,
                                       const Span& span) {
  const MirroredRay mirrored(ray, resolution);
  ClippedSpan clipped{span, -1};
  for (int a = 0; a < 3; ++a) {
    const bool flipped = mirrored.flip >> (2 - a) & 1U;
    const uint32_t near = flipped ? resolution - box.max[a] : box.min[a];
    const uint32_t far = flipped ? resolution - box.min[a] : box.max[a];
    const double in = mirrored.time(a, near), out = mirrored.time(a, far);
    if (in > clipped.span.begin) {
      clipped.span.begin = in;
      clipped.entry = a;
    }
    if (out < clipped.span.end) clipped.span.end = out;
  }
  if (clipped.span.begin >= clipped.span.end) return std::nullopt;
  return clipped;
}

// Whether `hit` is where the box cuts through matter: the ray was in it when it entered the box.
inline bool is_section(const ClippedSpan& clipped, const Hit& hit) {
  return hit.found && clipped.entry >= 0 && hit.t == clipped.span.begin;
}

}  // namespace svdag
