// Speck: a soup of triangles inside one voxel, however many there are, in a large empty box.
#include "streaming/error.h"
#include "tests/scenes/kinds.h"
#include "tests/scenes/numbers.h"

namespace svdag::scenes {
namespace {

constexpr double kHalf = 64;           // of the box's side
constexpr double kStep = 1.0 / 65536;  // what coordinates are multiples of
constexpr uint64_t kReach = 8;         // steps around the centre: a millionth of the side is 8.4
constexpr uint64_t kFarVertices = 6;   // two triangles that set the box
// The centre of a voxel at 64K, as far from its sides as at any coarser grid or farther.
constexpr Point kCentre{8773.5 / 512, -5054.5 / 512, 12009.5 / 512};

class Speck : public Mesh {
 public:
  Speck(uint64_t triangles, uint64_t seed) : triangles_(triangles), seed_(seed) {}

  uint64_t vertices() const override { return 3 * triangles_; }
  uint64_t faces() const override { return triangles_; }

  Point vertex(uint64_t i) const override {
    if (i < kFarVertices) return far_corner(i);
    uint64_t random = hash(seed_, i);
    Point p = kCentre;
    for (int a = 0; a < 3; ++a, random >>= 20)
      p[a] += kStep * (double((random & 0xfffff) % (2 * kReach + 1)) - double(kReach));
    return p;
  }
  Face face(uint64_t i) const override { return {3 * i, 3 * i + 1, 3 * i + 2}; }

 private:
  // A tiny triangle at each of two opposite corners of the box.
  static Point far_corner(uint64_t i) {
    const double sign = i < 3 ? -1 : 1;
    Point p{sign * kHalf, sign * kHalf, sign * kHalf};
    if (i % 3 != 0) p[int(i % 3)] -= sign * double(kReach) * kStep;
    return p;
  }

  uint64_t triangles_;
  uint64_t seed_;
};

}  // namespace

std::unique_ptr<Mesh> make_speck(uint64_t triangles, uint64_t seed) {
  if (triangles < 3) fail_usage("--triangles: a speck has at least 3 triangles");
  return std::make_unique<Speck>(triangles, seed);
}

}  // namespace svdag::scenes
