// Crossings of a triangle and axis-parallel segments between voxel centres: how the winding number
// changes along them.
//
// The winding number of a point counts how often the oriented surface winds around it. It is
// constant on a cube that no triangle touches, so one point of the cube decides it, and it changes
// where a path crosses a triangle: by -1 if the path leaves through the front (the side that the
// normal (v1 - v0) x (v2 - v0) points to), by +1 if it enters there.
//
// All points are shifted by d = (e, e^2, e^3), e infinitesimal, as in rule thin
// (builder/overlap/brick_thin.cpp). A shifted point is on no triangle, and a shifted segment meets
// no edge, so every crossing is unambiguous, also where a point is in a touched voxel. The winding
// number of a shifted point is the sum over any path to it, provided that the boundary chain of the
// triangles vanishes (io/scene/boundary_chain.h). Triangles of zero area are never crossed.
// `sheets` says which triangles count for nothing: those that are sheets of the set
// (io/triangle.h).
//
// Signs are computed in double with an error bound, and exactly where that is unsure. Rejected:
// rays along one axis from outside of the grid for each point (they leave the cube, so the cube's
// list of triangles would not suffice).
#pragma once

#include <span>

#include "builder/overlap/triangle_list.h"
#include "io/brick.h"

namespace svdag {

// The centre of the minimum voxel of a cube with the minimum corner `corner`.
inline LatticePoint first_centre(const LatticePoint& corner, int fraction) noexcept {
  return corner + (int64_t(1) << (fraction - 1));
}

// Whether the line through x along axis w passes through the triangle. Only the edge functions in
// `edges` are evaluated; the others hold at x.
bool is_crossed_by_line(const TriangleSetup& t, EdgeMask edges, int w,
                        const LatticePoint& x) noexcept;
// Whether x is on the front side of the plane of a triangle that has an area.
bool is_in_front(const TriangleSetup& t, const LatticePoint& x) noexcept;

// The winding number at `to` minus the winding number at `from`: the crossings along up to three
// segments, in the order x, y, z. Both points are in the cube whose list is `list`.
int crossings(std::span<const ListedTriangle> list, const LatticePoint& from,
              const LatticePoint& to, uint32_t sheets = kSheetOfUnion) noexcept;

// out[c] is the winding number at first_centre() of child c of the cube at `corner` of `side`
// lattice units, given the `winding` at first_centre() of the cube.
void windings_of_children(std::span<const ListedTriangle> list, const LatticePoint& corner,
                          int64_t side, int fraction, int32_t winding, int32_t out[8],
                          uint32_t sheets = kSheetOfUnion) noexcept;

// Calls visit(component, winding) for each set of untouched voxels of a brick that are connected
// within the brick by faces, edges or corners. `winding` is that of first_centre().
template <class Visit>
void for_each_untouched(std::span<const ListedTriangle> list, const LatticePoint& corner,
                        int fraction, int32_t winding, Brick touched, uint32_t sheets,
                        const Visit& visit);

// The voxels of `seed` and those of `voxels` that are connected to it.
Brick connected_voxels(Brick seed, Brick voxels) noexcept;

template <class Visit>
void for_each_untouched(std::span<const ListedTriangle> list, const LatticePoint& corner,
                        int fraction, int32_t winding, Brick touched, uint32_t sheets,
                        const Visit& visit) {
  const LatticePoint first = first_centre(corner, fraction);
  for (Brick left = ~touched; left != 0;) {
    const unsigned bit = unsigned(__builtin_ctzll(left));
    const Brick component = connected_voxels(Brick(1) << bit, left);
    const auto [x, y, z] = brick_voxel(bit);
    const LatticePoint at = first + LatticePoint(int64_t(x) << fraction, int64_t(y) << fraction,
                                                 int64_t(z) << fraction);
    visit(component, winding + (bit == 0 ? 0 : crossings(list, first, at, sheets)));
    left &= ~component;
  }
}

}  // namespace svdag
