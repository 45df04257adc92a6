// The part of a cut-out triangle in a cube, as a polygon of its texture, and whether it is opaque.
//
// The triangle is clipped by the six planes of the cube (Sutherland and Hodgman 1974), its texture
// coordinates with it, in doubles relative to the cube's corner. Corners are sorted first, so that
// neither order nor winding of the triangle matters, and the cube is larger by a margin, so that a
// triangle that touches it is not lost to rounding: a voxel is decided right if its opaque points
// are not all within kCutMargin voxels of its surface, or 2^-20 texel of what is transparent. It is
// a function of the triangle and the voxel alone.
#pragma once

#include "io/scene/cutouts/cut_out.h"
#include "io/triangle.h"

namespace svdag {

constexpr double kCutMargin = 0x1p-20;  // in voxels

struct CutTriangle {
  LatticeTriangle triangle;
  TextureCorners corners;
};

// Whether the triangle has an opaque point in the voxel at `corner`. `thin`: on one of the three
// segments that join the centres of opposite faces.
bool is_opaque_in_voxel(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
                        int64_t voxel, bool thin) noexcept;

// Decides most cubes of a triangle at once, as is_opaque_in_voxel() would decide their voxels.
//
// Texture coordinates are linear functions of space, constant along the triangle's normal, and
// points of the triangle are linear functions of texture coordinates. So the cube's part of the
// triangle is in a rectangle of the texture, and a block of the texture is in a box, and inside or
// outside of edges. A block that is apart from the cube in one of these directions does not count
// (the separating axes of the convex polygons cube and block cut out of the plane: nearly exact).
// All errors are bounded, and what is nearer decides nothing.
class CutPlane {
 public:
  CutPlane(const CutOut& cut, const CutTriangle& t, int64_t voxel) noexcept;

  // The triangle's opacity in a cube of `side` lattice units at `corner`.
  Opacity in_cube(const LatticePoint& corner, int64_t side) const noexcept {
    return decide(corner, side, false);
  }
  // Whether the triangle, which meets the cube, has an opaque point in it (kOpaque), or none.
  Opacity any_in_cube(const LatticePoint& corner, int64_t side) const noexcept {
    return decide(corner, side, true);
  }

 private:
  struct InCube;
  InCube place(const LatticePoint& corner, int64_t side) const noexcept;
  Opacity decide(const LatticePoint& corner, int64_t side, bool any) const noexcept;
  Opacity decide_by_blocks(const InCube& in, const TextureBox& box,
                           const OpacityMap::Blocks& blocks, bool any) const noexcept;
  bool has_point(const InCube& in, const double p[3], TexturePoint* at) const noexcept;
  bool has_opaque_middle(const InCube& in) const noexcept;
  bool has_opaque_corner(const InCube& in) const noexcept;

  const CutOut* cut_;
  double margin_;               // kCutMargin, in lattice units
  TextureBox box_;              // of the corners
  bool is_linear_ = false;      // false: the triangle is too thin
  bool is_invertible_ = false;  // false: it is in the texture
  LatticePoint start_;          // the corner v0 of the triangle
  double normal_[3];            // of length 1
  int axis_ = 0;                // of its largest coordinate
  // Spans are the sums of the magnitudes of the coefficients before them.
  double u_, v_, u_by_[3], v_by_[3];  // at v0, and by distance from it
  double u_span_ = 0, v_span_ = 0;
  double u_across_ = 0, v_across_ = 0;     // of points of the plane by the other two axes
  double by_u_[3], by_v_[3], by_span_[3];  // of points of the plane
  // The barycentric coordinates (the second and third, and the first as 1 less these).
  double edge_at_[3] = {1, 0, 0}, edge_by_[3][3], edge_span_[3] = {}, edge_by_u_[3], edge_by_v_[3];
};

}  // namespace svdag
