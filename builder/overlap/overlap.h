// The plain overlap tests: which children of a cube, and which voxels of a brick, a triangle
// touches.
//
// They are the reference for the kernels of builder/overlap/kernels/kernels.h.
//
// Precondition of both: the triangle's bounding box meets the closed cube, and every edge function
// that is not in `edges` holds everywhere in it. Children are decided on the safe side (an unsure
// child counts as touched, an unsure edge stays on); voxels are decided exactly.
#pragma once

#include "builder/overlap/triangle_list.h"
#include "io/brick.h"

namespace svdag {

struct ChildOverlap {
  uint32_t edges[8];  // the still undecided edge functions (an EdgeMask) in each touched child
  uint8_t touched;    // bit c: child c may be touched; a clear bit is certain
};

// The children, of a cube with centre (x, y, z), that `box` meets; `box` meets the cube.
inline uint8_t children_in_box(const LatticeBox& box, int64_t x, int64_t y, int64_t z) noexcept {
  unsigned children = 0xff;
  if (box.min.x > x) children &= 0b11110000;
  if (box.max.x < x) children &= 0b00001111;
  if (box.min.y > y) children &= 0b11001100;
  if (box.max.y < y) children &= 0b00110011;
  if (box.min.z > z) children &= 0b10101010;
  if (box.max.z < z) children &= 0b01010101;
  return uint8_t(children);
}

// `corner` and `side` of the parent cube in lattice units.
ChildOverlap overlap_children(const ListedTriangle& entry, const LatticePoint& corner,
                              int64_t side) noexcept;

// Numbers of signs of separating functions at voxels: evaluated in total, and of these decided
// exactly because double left them unsure.
struct DecisionCounts {
  uint64_t total = 0;
  uint64_t exact = 0;

  DecisionCounts& operator+=(const DecisionCounts& other) {
    total += other.total;
    exact += other.exact;
    return *this;
  }
};

// The voxels of the brick with minimum corner `corner` that the triangle touches; voxels have side
// 2^fraction.
Brick overlap_brick(const ListedTriangle& entry, const LatticePoint& corner, int fraction,
                    DecisionCounts* counts) noexcept;

// The voxels that the triangle sets under the thin rule (builder/overlap/brick_thin.cpp).
Brick overlap_brick_thin(const ListedTriangle& entry, const LatticePoint& corner, int fraction,
                         DecisionCounts* counts) noexcept;

}  // namespace svdag
