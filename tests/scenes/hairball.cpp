// Hairball: strands are tubes whose direction wanders with fractal noise, after the well-known
// test scene of Laine and Karras. A strand is a grid of rings x sides, so faces are arithmetic.
#include <algorithm>
#include <cmath>

#include "streaming/error.h"
#include "tests/scenes/kinds.h"
#include "tests/scenes/numbers.h"

namespace svdag::scenes {
namespace {

constexpr uint64_t kStrandSides = 6;
constexpr uint64_t kSegments = 80;
constexpr uint64_t kVertices = kStrandSides * (kSegments + 1);  // of one strand
constexpr uint64_t kFaces = 2 * kStrandSides * kSegments;
constexpr double kRadius = 48;       // of the ball
constexpr double kThickness = 0.06;  // of a strand

class Hairball : public Mesh {
 public:
  Hairball(uint64_t strands, uint64_t seed) : strands_(strands), seed_(seed) {}

  uint64_t vertices() const override { return strands_ * kVertices; }
  uint64_t faces() const override { return strands_ * kFaces; }

  Point vertex(uint64_t i) const override {
    const uint64_t strand = i / kVertices, ring = i % kVertices / kStrandSides, side = i % kStrandSides;
    const Point axis = direction(strand);
    const Point across = normalised(cross(axis, least_aligned(axis)));
    const Point other = cross(axis, across);
    const double turn = double(side) / double(kStrandSides);
    const double c = kThickness * cos_turns(turn), s = kThickness * sin_turns(turn);
    const Point centre = path(strand, axis, double(ring) / double(kSegments));
    Point p;
    for (int a = 0; a < 3; ++a) p[a] = centre[a] + (across[a] * c + other[a] * s);
    return p;
  }

  Face face(uint64_t i) const override {
    const uint64_t base = i / kFaces * kVertices, quad = i % kFaces / 2;
    const uint64_t side = quad % kStrandSides, next = (side + 1) % kStrandSides;
    const uint64_t low = base + quad / kStrandSides * kStrandSides, high = low + kStrandSides;
    return i % 2 == 0 ? Face{low + side, low + next, high + next}
                      : Face{low + side, high + next, high + side};
  }

 private:
  static Point cross(const Point& a, const Point& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
  }
  static Point least_aligned(const Point& p) {
    const double x = p.x * p.x, y = p.y * p.y, z = p.z * p.z;
    return x <= y && x <= z ? Point(1, 0, 0) : y <= z ? Point(0, 1, 0) : Point(0, 0, 1);
  }
  // Uniform on the sphere (Archimedes: the height is uniform).
  Point direction(uint64_t strand) const {
    const double y = 2 * uniform(seed_, 2 * strand) - 1, turn = uniform(seed_, 2 * strand + 1);
    const double r = std::sqrt(1 - y * y);
    return {r * cos_turns(turn), y, r * sin_turns(turn)};
  }
  // The point at `t` in [0, 1] from the centre of the ball to its surface.
  Point path(uint64_t strand, const Point& axis, double t) const {
    const uint64_t own = hash(seed_, ~strand);
    Point p;
    for (int a = 0; a < 3; ++a)
      p[a] = axis[a] + 0.35 * t * fractal(hash(own, uint64_t(a)), {4 * t, 0.5, 0.5}, 3);
    p = normalised(p);
    for (int a = 0; a < 3; ++a) p[a] *= kRadius * t;
    return p;
  }

  uint64_t strands_;
  uint64_t seed_;
};

}  // namespace

std::unique_ptr<Mesh> make_hairball(uint64_t triangles, uint64_t seed) {
  if (triangles < kFaces)
    fail_usage("--triangles: this scene needs at least " + std::to_string(kFaces) + " triangles");
  return std::make_unique<Hairball>(triangles / kFaces, seed);
}

}  // namespace svdag::scenes
