// Draws random bricks from a scene, by measures for which error bounds can be stated.
//
//   area          points uniform over the area of the triangles
//   longest edge  points uniform along the longest edges of the triangles: finds needles, which
//                 have length but no area
//   triangle      a point of a uniformly chosen triangle, moved by up to a voxel on each axis:
//                 finds tiny triangles, points, and the bricks beside a surface
//
// All measures are of the part of the snapped scene in the grid (with --bounds: in the selection),
// so no draw misses it. The first two draws are independent and uniform: k of n points in wrong
// bricks bound the share of that area, or length, that is in wrong bricks. The third is a search
// and bounds nothing.
// Rejected: a single measure. By area no needle is ever drawn, by length a carpet of small
// triangles hides a plane, by number a tessellated screw hides the walls.
#pragma once

#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "verify/sample/snapped_scene.h"

namespace svdag {

// A random number generator with the same results on every standard library, which std::uniform_*
// does not guarantee.
class Random {
 public:
  explicit Random(uint64_t seed) : engine_(seed) {}
  // Uniform in 0 .. n-1.
  uint64_t below(uint64_t n) { return uint64_t(UInt128(engine_()) * n >> 64); }
  // Uniform in [0, 1).
  double unit() { return double(engine_() >> 11) * 0x1p-53; }

 private:
  __extension__ typedef unsigned __int128 UInt128;
  std::mt19937_64 engine_;
};

enum class Measure { kArea, kLongestEdge, kNearTriangle };
constexpr size_t kMeasures = 3;

struct SceneDraw {
  std::array<std::vector<uint64_t>, kMeasures> codes;  // Morton codes of bricks, one per draw
  uint64_t near = 0;  // triangles whose box meets the selection; 0: the scene sets nothing there

  std::vector<uint64_t> all() const;
};

// Makes `count` draws, a third by each measure; a measure without weight (a scene without area, a
// scene of points) passes its draws to the next. The result is empty only if no triangle was found
// in the selection. Streams the scene twice.
SceneDraw draw_scene(const Scene& scene, const Grid& grid, uint64_t count, Random& random);

}  // namespace svdag
