// Near-planar patches: several triangles whose voxels in a cube equal those of one plane.
//
// The diagonal of a quad, a tessellated wall, coordinate noise, a gently curved surface: no single
// triangle covers the cube, yet their voxels are those of a plane. Notation: n_q the integer normal
// of one of them, w its dominant axis, g(x) = n_q . x, Q the cube's closed square along w; `list`
// holds all triangles that meet the closed cube. The memo's answer for the offsets [low, high]
// (builder/descend/plane_memo.h) is the cube's content if
//   P1  g of every triangle in the whole column of Q is in [low, high];
//   and one triangle covers Q, or
//   P2  every edge that meets the closed cube has a mate in the list: a triangle with the same two
//       snapped end points and its third vertex strictly on the other side, seen along w; and
//   P3  unless the cube is empty, some triangle covers the witness point of Q: the corner of least
//       g of a voxel that is set, if the voxel's layer in the direction of sign(n_q,w) w is at most
//       s - 3, else its corner of largest g.
//
// Why: a voxel that the plane misses is missed by P1. Over a corner of least (largest) g of a set
// voxel, [low, high] spans at most 3 voxels upwards (downwards) from that corner, so the choice of
// P3 keeps all of the surface there inside the cube. Between two such points its heights are
// between those at the ends, so inside as well; there the surface has no border (P2), so if it
// covers the witness it extends to every set voxel, and through it: at one corner it is above the
// voxel's floor, at the other below its ceiling. Where a condition fails the caller descends; all
// triangles must have w as their dominant axis, which leaves vertical ones, segments and points to
// the descent.
#pragma once

#include <optional>
#include <span>

#include "builder/descend/plane_memo.h"
#include "builder/overlap/triangle_list.h"

namespace svdag {

// Each condition left out gives wrong voxels; tests show it (tests/stress/patch_test.cpp).
struct PatchConditions {
  bool whole_column = true;  // P1 in the column of Q, not only at the cube's corner
  bool mates = true;         // P2: edges in the cube have mates ...
  bool other_side = true;    // ... on the other side
  bool witness = true;       // P3
};

// Whether the normals are so near that P1 may hold in a cube of `voxels` on a side: a quick look,
// in double and without a proof. All must have one dominant axis.
bool may_be_patch(std::span<const ListedTriangle> list, int64_t voxels) noexcept;

// P1: a range that holds g - g(corner) of every triangle over the column of Q; none if a triangle
// has another dominant axis than the plane or an offset is out of range.
std::optional<OffsetRange> offsets_of_patch(std::span<const ListedTriangle> list,
                                            const LatticePlane& plane, const LatticePoint& corner,
                                            int64_t side,
                                            const PatchConditions& conditions) noexcept;
// P2.
bool has_no_border(std::span<const ListedTriangle> list, int w, const LatticePoint& corner,
                   int64_t side, const PatchConditions& conditions) noexcept;
// P3: `voxel` is a set voxel of the cube with `voxels` on a side.
bool covers_witness(std::span<const ListedTriangle> list, const LatticePlane& plane,
                    const LatticePoint& corner, int fraction, int64_t voxels,
                    const Witness& witness) noexcept;

}  // namespace svdag
