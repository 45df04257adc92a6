// Which points of a material are opaque: those where the alpha of its texture reaches a threshold.
//
// The alpha of a point is that of its texel if the texture is sampled to the nearest, and bilinear
// between the centres of four texels otherwise (glTF 2.0, 3.8.4): what a viewer shows from near.
//
// A polygon in the plane of the texture is decided by halving the rectangle of cells that it meets
// (io/scene/cutouts/opacity_map.h). Where a rectangle is neither opaque nor transparent, both
// halves are looked at, down to single cells. There the largest alpha is at a corner of the polygon
// or on an edge, as a bilinear function has no maximum inside. So the cost grows with the border of
// the opaque part, not with the texels. Rejected: pieces of triangles along the texels (cracks, and
// work that grows with the texels).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "io/scene/cutouts/alpha_image.h"
#include "io/scene/cutouts/opacity_map.h"

namespace svdag {

// In texels: texel i of a row holds [i, i + 1).
struct TexturePoint {
  double u, v;
  auto operator<=>(const TexturePoint&) const = default;
};
using TextureCorners = std::array<TexturePoint, 3>;  // of a triangle
constexpr double kMaxTextureCoordinate = 0x1p40;     // exclusive
// Whether a point is finite, and near enough for its texel to have a number.
inline bool is_placeable(const TexturePoint& p) {
  return std::abs(p.u) < kMaxTextureCoordinate && std::abs(p.v) < kMaxTextureCoordinate;
}

// Convex; a segment or a point has fewer than three corners, or some of them twice.
struct TexturePolygon {
  static constexpr size_t kMaxCorners = 24;
  std::array<TexturePoint, kMaxCorners> corners;  // not initialised
  size_t size = 0;

  TexturePolygon() {}  // NOLINT: = default would set all corners

  void add(const TexturePoint& p) {
    if (size < kMaxCorners) corners[size++] = p;
  }
};

struct TextureBox {
  TexturePoint low, high;
};
// The bounds of a polygon of one corner or more.
TextureBox bounds_of(const TexturePolygon& polygon) noexcept;

struct CutOut {
  std::shared_ptr<const AlphaImage> image;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;
  double threshold = 127.5;  // alpha in 0 .. 255 from which on a point is opaque

  std::shared_ptr<const OpacityMap> map = nullptr;  // of the above; the functions below need it

  bool operator==(const CutOut& other) const {
    return image == other.image && wrap_u == other.wrap_u && wrap_v == other.wrap_v &&
           nearest == other.nearest && threshold == other.threshold;
  }
  // Whether no texel is transparent, so that nothing is cut.
  bool is_opaque() const { return image->least() >= threshold; }
  // Whether every texel is.
  bool is_transparent() const { return image->greatest() < threshold; }
};

// The same with its map.
CutOut with_map(CutOut cut);

// kOpaque or kTransparent: all points within half_u and half_v, and a margin of 2^-20 texel, of
// `centre` are; kMixed decides nothing. *blocks: those of the points, if they were looked up and
// are mixed, else none.
Opacity opacity_near(const CutOut& cut, const TexturePoint& centre, double half_u, double half_v,
                     OpacityMap::Blocks* blocks) noexcept;

// The largest alpha of a bilinear texture in the part of the box in cell i of row j.
double largest_alpha_in_box(const CutOut& cut, int64_t i, int64_t j,
                            const TextureBox& box) noexcept;

// Whether a point of the polygon is opaque. A polygon in which more than 2^14 rectangles decide
// nothing is taken for opaque.
bool has_opaque_point(const CutOut& cut, const TexturePolygon& polygon) noexcept;

// The alpha at a point, 0 to 255.
double alpha_at(const CutOut& cut, const TexturePoint& p) noexcept;

}  // namespace svdag
