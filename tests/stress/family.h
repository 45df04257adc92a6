// Families of awkward geometry: each draws triangles near a spot of a grid.
//
// A family about shapes draws on the lattice; a family about coordinates draws doubles in the world
// and snaps them (io/lattice.h), so that the snap is in the path. Either way the lattice triangles
// are the normative geometry that voxelizer and judge are asked about.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/stress/spot.h"

namespace svdag {

using Soup = std::vector<LatticeTriangle>;

struct Family {
  std::string name;
  std::function<Soup(const Spot&, StressRandom*)> draw;
  SpotArea area = SpotArea::kAnywhere;
  std::function<Grid(int levels, StressRandom*)> grid = [](int levels, StressRandom*) {
    return unit_grid(levels);
  };
};

// How GoogleTest names a family.
inline void PrintTo(const Family& family, std::ostream* out) {
  *out << family.name;
}

std::vector<Family> shape_families();       // small, giant, slivers, degenerate
std::vector<Family> plane_families();       // exactly on, and next to, the planes of the grid
std::vector<Family> contact_families();     // touching a cell by a corner, an edge or a face
std::vector<Family> coordinate_families();  // scenes far away, scaled, denormal
std::vector<Family> format_families();      // what glTF transforms and Draco quantisation give
std::vector<Family> range_families();       // the bit budget of the exact tests, and beyond it
std::vector<Family> patch_families();       // several triangles that are nearly one plane
std::vector<Family> all_families();

// The triangle with two given vertices whose centroid is `at`.
inline LatticeTriangle around_centroid(const LatticePoint& at, const LatticePoint& a,
                                       const LatticePoint& b) {
  return {{a, b, at * int64_t(3) - a - b}};
}

}  // namespace svdag
