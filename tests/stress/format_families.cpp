// Families of coordinates that scene formats produce: glTF node transforms, Draco quantisation.
#include <cmath>

#include "io/float_rounding.h"
#include "io/scene/gltf/gltf_nodes.h"
#include "tests/stress/world.h"

namespace svdag {
namespace {

// Quarter turns about axes and diagonals as quaternions, normalised or not.
std::array<double, 4> quarter_turn(StressRandom* random) {
  std::array<double, 4> q{};
  const double length = random->coin() ? std::sqrt(0.5) : double(random->between(1, 3));
  q[random->below(4)] = length * double(random->sign());
  if (random->coin()) {
    q[random->below(4)] = length * double(random->sign());
  } else if (random->coin()) {
    for (double& c : q) c = length * double(random->sign());  // a third of a turn
  }
  return q;
}

std::array<double, 3> mirrored_scale(StressRandom* random) {
  static constexpr double kScales[4] = {1, 2, 0.5, 0.1};
  std::array<double, 3> scale;
  for (double& s : scale) s = kScales[random->below(4)] * double(random->sign());
  return scale;
}

// Corners on half voxels, turned and mirrored by two nodes: on planes again, or off them by the
// rounding of the transform.
Soup gltf_nodes(const Spot& spot, StressRandom* random) {
  Trs parent, child;
  const Point at = to_world(spot.grid, Point(spot.corner(random)) / double(spot.voxel()));
  for (size_t a = 0; a < 3; ++a) parent.translation[a] = at[int(a)];
  parent.rotation = quarter_turn(random);
  child.rotation = quarter_turn(random);
  child.scale = mirrored_scale(random);
  const Affine node = compose(parent.affine(), child.affine());
  std::vector<Triangle> triangles(3);
  for (Triangle& t : triangles) {
    for (Point& p : t.v) p = node(Point(random->point(16)) * 0.5);
  }
  return snapped(spot.grid, triangles);
}

// Integers of `bits` bits over a range of the grid's size, dequantised in double as
// io/scene/decoders/draco.cpp does: float minimum and range, min + k * (range / (2^bits - 1)).
Family draco(const char* name, int bits) {
  return {name, [bits](const Spot& spot, StressRandom* random) {
            const double last = double((int64_t(1) << bits) - 1);
            const double range =
                round_to_float(double(spot.grid.resolution()) * (0.5 + 0.4 * random->unit()));
            const double step = range / last;
            const Point at = to_world(spot.grid, anchor_in_voxels(spot, random));
            Point low, near;  // the minimum, and the integers of the vertex near `at`
            for (int a = 0; a < 3; ++a) {
              near[a] = double(random->between(4, int64_t(last) - 4));
              low[a] = round_to_float(at[a] - near[a] * step);
            }
            std::vector<Triangle> triangles(4);
            for (Triangle& t : triangles) {
              for (Point& p : t.v) {
                const Point k = near + Point(random->point(2));
                for (int a = 0; a < 3; ++a) p[a] = low[a] + k[a] * step;
              }
              const int vertex = random->axis();
              for (int a = 0; a < 3; ++a) t.v[vertex][a] = low[a] + near[a] * step;
            }
            return snapped(spot.grid, triangles);
          }};
}

}  // namespace

std::vector<Family> format_families() {
  return {{"gltf_turns_and_mirrors", gltf_nodes},
          draco("draco_11_bits", 11),
          draco("draco_14_bits", 14),
          draco("draco_16_bits", 16)};
}

}  // namespace svdag
