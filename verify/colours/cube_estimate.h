// The colour that a cube should have: the mean over points drawn on the triangles inside, and how
// far from it a right colour may be.
//
//   colour = integral of (opacity x colour) / integral of opacity, over the parts of the triangles
//            in the closed cube, in linear light
//
// Per triangle the part in the cube is a polygon, clipped in doubles; points are stratified over
// it, about kPointsPerFace on the area of a face, and the finest level of the texture is sampled.
//
// A right colour differs from this mean
//   * by the error of the mean: variance / points;
//   * by the error of the few points that define the colour of a file, four for a large part of a
//     triangle and one for a small one: variance / 4, or the variance. These points, and the strata
//     here, lie evenly and miss no linear change of colour: the variance is what is left of it.
//     Four standard errors are allowed, of both together: means of four points have longer tails
//     than a normal distribution, and of 50,000 cubes of a forest one was beyond three. Where so
//     much is transparent that the few points may miss what is opaque, every colour of an opaque
//     point is allowed;
//   * where a cube spans four texels or more, as it is defined by a coarser level of the texture,
//     whose texels reach beyond it. The mean is taken four times more, with points moved by up to
//     half a cube in each of the four directions, and half as much again as the largest difference
//     is allowed.
// Texels that are squares are summed exactly where a cube spans less than two.
// So the tolerance is next to nothing where a cube spans few texels or a smooth part of a texture,
// and large in noise. Rejected: a fixed one, which either misses half a texel or fails foliage.
#pragma once

#include <array>

#include "io/triangle.h"
#include "verify/colours/judged_texture.h"
#include "verify/sample/scene_draw.h"

namespace svdag {

// A snapped triangle with what colours it.
struct JudgedTriangle {
  std::array<LatticePoint, 3> corners;
  std::array<double, 3> colour{1, 1, 1};   // linear light; of all points, without paint
  const Paint* paint = nullptr;            // the factor, and the modes of the texture
  const JudgedTexture* texture = nullptr;  // null: none
  TextureCorners points = {};
  CornerColours corner_colours = kWhiteCorners;
};

class CubeEstimate {
 public:
  static constexpr double kPointsPerFace = 1024;
  static constexpr double kMinArea = 0x1p-20;  // of a face, to have a mean

  // Adds the part of the triangle in the cube of `side` lattice units at `corner`.
  void add(const JudgedTriangle& t, const LatticePoint& corner, int64_t side, Random& random);

  // Whether a triangle meets the cube, or nearly does.
  bool is_touched() const { return is_touched_; }
  // Whether the triangles have area in the cube that is opaque.
  bool has_mean() const { return sum_[0] > kMinArea; }
  // Linear light of a channel, 0 .. 2; has_mean().
  double mean(size_t channel) const { return sum_[channel + 1] / sum_[0]; }
  // Whether parts of textures that are not neighbours meet here: different images, or a gap of more
  // than a texel between the places of the triangles' parts.
  bool is_at_seam() const;
  // Steps of sRGB that the decoders of the textures may differ by.
  double decoder_error() const { return decoder_error_; }
  // Within which of the mean a right colour is.
  double tolerance(size_t channel) const;

 private:
  // Second moments of a sample: of the weight, of weight and channel, of the channels.
  struct Moments {
    double weight = 0;
    std::array<double, 3> mixed{}, channel{};
  };
  class PolygonSample;
  // Where the parts of the triangles are in their textures.
  struct Places {
    const JudgedTexture* texture = nullptr;  // of the first
    TextureBox box{};                        // of all
    TexturePoint sides{0, 0};                // of the boxes of all, in sum
    bool is_mixed = false;                   // other textures, or none, were met
    uint64_t count = 0;
  };
  void note_place(const JudgedTexture* texture, const TexturePolygon& part);

  bool is_touched_ = false;
  double decoder_error_ = 0;
  WeightedColour sum_{};                         // by area
  std::array<double, 3> low_{1, 1, 1}, high_{};  // of opaque points
  std::array<WeightedColour, 4> moved_{};        // of the four means of moved points
  Moments variance_;                             // of sum_
  Places places_;
};

}  // namespace svdag
