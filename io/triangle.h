// Points and triangles, in the world (double) and on the lattice (integers).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>

namespace svdag {

using Point = glm::dvec3;                   // world space, in the units of the scene
using LatticePoint = glm::vec<3, int64_t>;  // sub-voxel units of the grid, see io/lattice.h

struct Triangle {
  std::array<Point, 3> v;
};

// Of which sets of a bake a triangle is a sheet only (io/scene/open_parts.h).
constexpr uint32_t kSheetOfUnion = 1, kSheetOfLayer = 2, kSheets = 3;
constexpr uint32_t kMaxCut = (uint32_t(1) << 30) - 1;

// The normative geometry: everything after the snap is decided on these integers alone.
struct LatticeTriangle {
  std::array<LatticePoint, 3> v;
  uint32_t subject = 0;    // with layers: its layer (builder/octree/subject.h)
  uint32_t sheet : 2 = 0;  // kSheetOf...: of an open part, which bounds no solid
  uint32_t cut : 30 = 0;   // not 0: a cut-out triangle (io/scene/cutouts/cut_records.h)
  bool operator==(const LatticeTriangle&) const = default;
};

// A closed box on the lattice.
struct LatticeBox {
  LatticePoint min{0};
  LatticePoint max{0};

  // Whether the closed boxes have a point in common; boxes that touch do.
  bool meets(const LatticeBox& other) const noexcept {
    for (int a = 0; a < 3; ++a) {
      if (max[a] < other.min[a] || min[a] > other.max[a]) return false;
    }
    return true;
  }
  // Whether `other` is a subset of this box.
  bool holds(const LatticeBox& other) const noexcept {
    for (int a = 0; a < 3; ++a) {
      if (other.min[a] < min[a] || other.max[a] > max[a]) return false;
    }
    return true;
  }
  void add(const LatticeBox& other) noexcept {
    for (int a = 0; a < 3; ++a) {
      min[a] = std::min(min[a], other.min[a]);
      max[a] = std::max(max[a], other.max[a]);
    }
  }
};

inline LatticeBox box_of(const LatticeTriangle& t) noexcept {
  LatticeBox box;
  for (int a = 0; a < 3; ++a) {
    box.min[a] = std::min(std::min(t.v[0][a], t.v[1][a]), t.v[2][a]);
    box.max[a] = std::max(std::max(t.v[0][a], t.v[1][a]), t.v[2][a]);
  }
  return box;
}

// A closed box in world space; empty until a point is added.
struct Box {
  Point min{std::numeric_limits<double>::infinity()};
  Point max{-std::numeric_limits<double>::infinity()};

  bool empty() const { return !(min.x <= max.x && min.y <= max.y && min.z <= max.z); }
  void add(const Point& p) {
    for (int a = 0; a < 3; ++a) {
      if (p[a] < min[a]) min[a] = p[a];
      if (p[a] > max[a]) max[a] = p[a];
    }
  }
  // Adds the three corners, which must be finite, without branches. Same result as three calls in
  // order: of equal values (0 and -0) the earlier one stays.
  void add(const Triangle& t) {
    const auto less = [](double first, double then) { return then < first ? then : first; };
    const auto more = [](double first, double then) { return first < then ? then : first; };
    for (int a = 0; a < 3; ++a) {
      const double p = t.v[0][a], q = t.v[1][a], r = t.v[2][a];
      min[a] = less(min[a], less(less(p, q), r));
      max[a] = more(max[a], more(more(p, q), r));
    }
  }
  void add(const Box& other) {
    if (other.empty()) return;
    add(other.min);
    add(other.max);
  }
};

}  // namespace svdag
