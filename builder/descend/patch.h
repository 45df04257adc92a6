// Near-planar patches: several triangles that set the same voxels of a cube as one plane.
//
// Examples: the diagonal of a quad, a tessellated wall, coordinate noise, a gently curved surface.
// No single triangle covers the cube, yet their voxels are those of a plane. Notation: n_q is the
// integer normal of one of them, w its dominant axis, g(x) = n_q . x, Q the cube's closed square
// along w, s the side of the cube in voxels; `list` holds all triangles that meet the closed cube.
// The memo's answer for the offsets [low, high] (builder/descend/plane_memo.h) is the cube's
// content if
//   P1  g of every triangle in the whole column of Q is in [low, high];
//   and one triangle covers Q, or
//   P2  every edge that meets the closed cube has a mate in the list: a triangle with the same two
//       snapped end points and its third vertex strictly on the other side, seen along w; and
//   P3  unless the cube is empty, some triangle covers the witness point of Q: the corner of
//       smallest g of a voxel that is set, if the voxel's layer in the direction of sign(n_q,w) w
//       is at most s - 3, else its corner of largest g.
//
// Proof: by P1 the triangles miss every voxel that the plane misses. From a corner of smallest
// (largest) g of a set voxel, [low, high] spans at most 3 voxels upwards (downwards), so with the
// choice of P3 the surface over this corner is inside the cube. Between two such points its heights
// are between those at the ends, so inside as well; by P2 the surface has no border there. If it
// covers the witness it therefore extends to every set voxel, and passes through it: at one corner
// it is above the voxel's floor, at the other below its ceiling.
//
// Where a condition fails, the caller descends. All triangles must have the dominant axis w, so
// vertical triangles, segments and points are left to the descent.
#pragma once

#include <optional>
#include <span>

#include "builder/descend/plane_memo.h"
#include "builder/overlap/triangle_list.h"

namespace svdag {

// Switches for tests: without any one of the conditions voxels are wrong
// (tests/stress/patch_test.cpp).
struct PatchConditions {
  bool whole_column = true;  // P1 in the column of Q, not only at the cube's corner
  bool mates = true;         // P2: edges in the cube have mates ...
  bool other_side = true;    // ... on the other side
  bool witness = true;       // P3
};

// Whether the triangles have one dominant axis and normals so similar that P1 may hold in a cube of
// `voxels` voxels a side. A quick filter in double, not a proof.
bool may_be_patch(std::span<const ListedTriangle> list, int64_t voxels) noexcept;

// P1: a range that contains g - g(corner) of every triangle over the column of Q; none if the
// dominant axis of a triangle is not that of the plane, or an offset is out of range.
std::optional<OffsetRange> offsets_of_patch(std::span<const ListedTriangle> list,
                                            const LatticePlane& plane, const LatticePoint& corner,
                                            int64_t side,
                                            const PatchConditions& conditions) noexcept;
// P2: whether every edge that meets the cube has a mate.
bool has_no_border(std::span<const ListedTriangle> list, int w, const LatticePoint& corner,
                   int64_t side, const PatchConditions& conditions) noexcept;
// P3: whether a triangle covers the witness point. `witness` is a set voxel of the cube, which has
// `voxels` voxels a side.
bool covers_witness(std::span<const ListedTriangle> list, const LatticePlane& plane,
                    const LatticePoint& corner, int fraction, int64_t voxels,
                    const Witness& witness) noexcept;

}  // namespace svdag
