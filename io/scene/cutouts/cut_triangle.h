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

// The opacity of the triangle in a cube of `side` lattice units at `corner`; a voxel has `voxel`.
Opacity opacity_in_cube(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
                        int64_t side, int64_t voxel) noexcept;

// Whether the triangle has an opaque point in the voxel at `corner`. `thin`: on one of the three
// segments that join the centres of opposite faces.
bool is_opaque_in_voxel(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
                        int64_t voxel, bool thin) noexcept;

// Decides most voxels of a few around `corner` at once, as is_opaque_in_voxel() would: by the
// texture coordinates as linear functions of space, constant along the triangle's normal.
class CutPlane {
 public:
  CutPlane(const CutOut& cut, const CutTriangle& t, const LatticePoint& corner,
           int64_t voxel) noexcept;

  // Of the voxel x, y, z from the corner on, which the triangle meets.
  Opacity in_voxel(int x, int y, int z) const noexcept;

 private:
  const CutOut& cut_;
  bool is_known_ = false;   // false: the triangle is too thin
  TexturePoint first_;      // at the centre of the first voxel
  TexturePoint step_[3];    // to the next one along each axis
  double half_u_, half_v_;  // from the centre of a voxel to its corners
};

}  // namespace svdag
