// Which points of a material are opaque: those where the alpha of its texture reaches a threshold.
//
// The alpha of a point is that of its texel if the texture is sampled to the nearest, and bilinear
// between the centres of four texels otherwise (glTF 2.0, 3.8.4): what a viewer shows from near.
//
// A polygon in the plane of the texture is decided by halving the rectangle of cells that it meets
// (a cell: the square between four centres, or a texel). The texels of a rectangle have a least and
// a largest alpha; if these do not decide, both halves are looked at, down to single cells. There
// the largest alpha is at a corner of the polygon or on an edge, as a bilinear function has no
// maximum inside. Before, a rectangle of few cells is decided by the alpha in its middle and the
// steepest slope between its texels. So the cost grows with the border of the opaque part, not with
// the texels. Rejected: pieces of triangles along the texels (cracks, and work that grows with the
// texels).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "io/scene/cutouts/alpha_image.h"
#include "io/scene/cutouts/wrap.h"

namespace svdag {

// In texels: texel i of a row holds [i, i + 1).
struct TexturePoint {
  double u, v;
  auto operator<=>(const TexturePoint&) const = default;
};
using TextureCorners = std::array<TexturePoint, 3>;  // of a triangle
constexpr double kMaxTextureCoordinate = 0x1p40;     // exclusive, and finite

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

enum class Opacity : uint8_t { kTransparent, kOpaque, kMixed };

struct CutOut {
  std::shared_ptr<const AlphaImage> image;
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
  bool nearest = false;
  double threshold = 127.5;  // alpha in 0 .. 255 from which on a point is opaque

  bool operator==(const CutOut&) const = default;
};

// Whether no texel is transparent, so that nothing is cut.
bool is_opaque(const CutOut& cut) noexcept;

// kOpaque or kTransparent: all points within half_u and half_v, and a margin of 2^-20 texel, of
// `centre` are; kMixed decides nothing.
Opacity opacity_near(const CutOut& cut, const TexturePoint& centre, double half_u,
                     double half_v) noexcept;

// Whether a point of the polygon is opaque. A polygon in which more than 2^14 rectangles decide
// nothing is taken for opaque.
bool has_opaque_point(const CutOut& cut, const TexturePolygon& polygon) noexcept;

// The alpha at a point, 0 to 255.
double alpha_at(const CutOut& cut, const TexturePoint& p) noexcept;

}  // namespace svdag
