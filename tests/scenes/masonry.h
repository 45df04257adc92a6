// The building blocks of the atrium: blocks, turned columns, round arches, cloth, leaves.
//
// Everything is placed in a Frame whose axes are a = along the wall, y = up, c = out of the wall.
#pragma once

#include <utility>
#include <vector>

#include "tests/scenes/numbers.h"
#include "tests/scenes/patches.h"

namespace svdag::scenes {

struct Frame {
  Point origin{0};
  Point along{1, 0, 0};
  Point out{0, 0, 1};

  Point at(double a, double y, double c) const {
    Point p = origin;
    for (int k = 0; k < 3; ++k) p[k] += along[k] * a + out[k] * c;
    p.y += y;
    return p;
  }
  Frame moved(double a, double y, double c) const { return {at(a, y, c), along, out}; }
};

using Profile = std::vector<std::pair<double, double>>;  // (radius, height), from the foot up

struct Arch {
  double width;      // of the wall around the opening
  double radius;     // of the opening, centred at width / 2
  double spring;     // height at which the arch begins
  double top;        // of the wall
  double thickness;  // of the wall, half to each side of c = 0
};

class Masonry {
 public:
  // The part and the material of the patches from here on.
  void part(const char* name, const char* material) { part_ = name, material_ = material; }
  std::vector<Patch> take() { return std::move(patches_); }

  // The box a0..a1, y0..y1, c0..c1.
  void block(const Frame& f, const Point& low, const Point& high);
  // Only its upper side and the four walls, for boxes on a floor.
  void tile(const Frame& f, const Point& low, const Point& high);
  // A flat patch with corners p, p + u, p + v, p + u + v in the frame.
  void sheet(const Frame& f, const Point& p, const Point& u, const Point& v);
  // A surface of revolution about the frame's y axis; `cell` as in Patch.
  void turned(const Frame& f, const Profile& profile, uint32_t cell = 0);
  // The part of a wall above `spring`, with a round opening and a moulding along it.
  void arch(const Frame& f, const Arch& arch);
  // A column with base and capital whose abacus ends at `height`.
  void column(const Frame& f, double height, double radius);
  // Thin cloth hanging down from y = 0, 0 <= a <= width, with folds that open towards the hem.
  void curtain(const Frame& f, double width, double drop, uint64_t seed);
  // A vase with leaves.
  void plant(const Frame& f, uint64_t seed);

 private:
  Patch& add(std::function<Point(double, double)> surface, double width, double height,
             uint32_t multiple_u = 1, uint32_t multiple_v = 1) {
    patches_.push_back(
        {std::move(surface), width, height, multiple_u, multiple_v, part_, material_});
    return patches_.back();
  }
  // One whose texture follows its lengths.
  Patch& add_bent(std::function<Point(double, double)> surface, double width, double height,
                  uint32_t multiple_u, uint32_t multiple_v, double chart_width) {
    Patch& patch = add(std::move(surface), width, height, multiple_u, multiple_v);
    patch.mapping = Mapping::kLengths;
    patch.chart_width = chart_width;
    return patch;
  }
  void arch_face(const Frame& f, const Arch& arch, double c);
  void leaf(const Frame& f, double turn, double size);

  std::vector<Patch> patches_;
  const char* part_ = "stone";
  const char* material_ = "limestone";
};

}  // namespace svdag::scenes
