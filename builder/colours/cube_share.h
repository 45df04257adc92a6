// The share of one triangle in the colour of one cube Q: the area of the triangle inside, and the
// mean of its colour there. This header defines the colour of a covered cube.
//
// colour of Q = (sum of a c) / (sum of a)    over all triangles of the scene that meet the closed Q
//
//   a   area of the triangle in Q, in units of 2^-40 of a face of Q, times the share of it that is
//       opaque, rounded
//   c   its mean colour there in linear light, 16 bits a channel, rounded
//
// a and c are integers before they are added, in 128 bits: 2^30 triangles need 87. So order, split,
// threads and memory do not matter; the quotient is rounded half up. Both come from one polygon: in
// the projection along the triangle's dominant axis w the unit square of Q is clipped by the slab
// 0 <= z <= 1 of the plane and by the three edges, then divided into a fan from its first corner. A
// part of area below 1/16 has one sample, at its centroid; a larger one has four, at the centroids
// of the four triangles that its middles make; a whole square has 2 x 2. a is the projected area
// times |n| / |n_w|.
//
// Corners are sorted first, positions are exact integers relative to the corner of Q, and every
// operation is a double in fixed order: a function of the triangle and Q only. On what this needs
// beyond an area-weighted mean:
//
// * Level of the texture. Q's edge spans s texels of the finest level, by the larger stretch, but
//   no triangle is larger than itself: s is at most the range of its coordinates. So a mesh that is
//   finer than the cubes is read without bleeding between charts, and a sliver, whose stretch is an
//   accident, does not read the mean of the image. The level is that where s is 2 to 4 texels.
// * Slivers. Samples are clamped to the range of the corners' coordinates and colours: the gradient
//   of a sliver cannot extrapolate to texels that it does not have.
// * Nearest. Texels of a sampler that shows squares are squares where s < 2, and each weighs its
//   area in Q, so a voxel world has its own colours. Beyond, there are too many, and the bilinear
//   mean is near.
// * Cut-outs. A texel that is cut out weighs nothing (io/scene/colours/linear_image.h).
// * Which triangles meet Q matters where they have next to no area (a wall that touches the face
//   of Q): a triangle with a >= 2^20 does, others and very large ones are decided in exact
//   integers. So it does not depend on the descent, which is on the safe side.
// * No area. If the a sum to 0, the colour is the mean of the colours at the points nearest to
//   Q's centre, weighted by their opacity. If nothing is opaque there either (what Q has of a
//   cut-out is its edge), each has the colour of the finest level that is not transparent there.
// * One colour. A cube is constant if all triangles that meet it have the same one colour.
#pragma once

#include <array>
#include <cstdint>

#include "builder/colours/painted_triangle.h"
#include "builder/overlap/triangle_setup.h"

namespace svdag {

constexpr int kAreaBits = 40;
constexpr uint64_t kSurelyMeets = uint64_t(1) << 20;  // a triangle with this area in Q meets Q

struct CubeShare {
  uint64_t area = 0;  // a
  std::array<uint16_t, 3> colour{};
};

// A triangle, prepared for cubes of one size. Lengths are in sides of a cube.
class ShareSetup {
 public:
  // `setup`: of t.triangle(). `side_log2`: of a cube in lattice units. `paints` must outlive this.
  ShareSetup(const PaintedTriangle& t, const TriangleSetup& setup, const Paints& paints,
             int side_log2) noexcept;

  // In the cube with minimum corner `corner`, which a box around the triangle meets.
  CubeShare share_in(const LatticePoint& corner) const noexcept;
  // At the point that is nearest to the centre of the cube; area: opacity, 0 .. 65535. Where it is
  // transparent: of the finest level of the texture that is not.
  CubeShare nearest_to_centre(const LatticePoint& corner) const noexcept;

 private:
  struct Polygon;
  struct Affine2 {  // base + a at_a + b at_b, within [low, high]
    double base = 0, a = 0, b = 0, low = 0, high = 0;
  };

  Affine2 interpolate(double at0, double at1, double at2) const noexcept;
  ColourSum sample(double a, double b) const noexcept;
  bool add_squares(const Polygon& polygon, double at_a, double at_b, ColourSum* sum) const noexcept;
  ColourSum sample_at(const LevelSampler& sampler, double u, double v,
                      const double colour[3]) const noexcept;
  CubeShare share_of(const ColourSum& sum, double area) const noexcept;

  LatticePoint position_[3];
  int side_log2_;
  double unit_;    // 1 / side
  int w_, i_, j_;  // dominant axis, and the two of the projection
  bool has_area_ = false;
  double slope_a_ = 0, slope_b_ = 0;  // z = slope_a a + slope_b b + a constant
  double edge_a_[3], edge_b_[3];      // coefficients of the edge functions
  double stretch_ = 0;                // |n| / |n_w|, times 2^kAreaBits
  double determinant_ = 0;            // of the two edges from corner 0 in the projection
  double to1_[2], to2_[2];            // these edges
  size_t image_level_ = 0;
  bool has_one_colour_, has_texture_ = false, has_holes_ = false, has_colours_ = false;
  bool has_squares_ = false;
  std::array<uint16_t, 3> colour_;
  double factor_[3];
  const Paint* paint_ = nullptr;
  LevelSampler sampler_;
  Affine2 u_, v_, colours_[3];        // relative to corner 0
  double corner_u_[3], corner_v_[3];  // in texels of the finest level
  double corner_colour_[3][3];
};

// The product of area and larger stretch of a triangle, in texels times voxels, and its area, in
// units of 2^-20: of those that have no one colour. Corners with different colours count as texels
// that are the mean edge apart.
struct TexelDensity {
  unsigned __int128 texels = 0, area = 0;

  void add(const PaintedTriangle& t, int fraction) noexcept;
};

}  // namespace svdag
