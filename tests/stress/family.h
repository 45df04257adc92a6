// Families of difficult geometry: each draws triangles near a spot of a grid.
//
// Families of shapes draw on the lattice. Families of coordinates draw world coordinates in double
// and snap them (io/lattice.h), so that they test the snap too. The lattice triangles are the input
// of both voxelizer and judge.
#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "tests/stress/test_spot.h"

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
std::vector<Family> plane_families();       // exactly on the planes of the grid, and next to them
std::vector<Family> contact_families();     // touching a cell by a corner, an edge or a face
std::vector<Family> coordinate_families();  // scenes far away, scaled, denormal
std::vector<Family> format_families();      // results of glTF transforms and Draco quantisation
std::vector<Family>
range_families();  // coordinates up to the bit limits of the exact tests, and beyond
std::vector<Family> patch_families();  // several triangles that are nearly one plane
std::vector<Family> all_families();

// A solid of which `soup` is a part: each triangle becomes a tetrahedron with the vertex `apex`.
inline Soup closed_up(const Soup& soup, const LatticePoint& apex) {
  Soup closed = soup;
  for (const LatticeTriangle& t : soup) {
    for (size_t i = 0; i < 3; ++i) closed.push_back({{t.v[(i + 1) % 3], t.v[i], apex}});
  }
  return closed;
}

// The triangle with two given vertices whose centroid is `at`.
inline LatticeTriangle around_centroid(const LatticePoint& at, const LatticePoint& a,
                                       const LatticePoint& b) {
  return {{a, b, at * int64_t(3) - a - b}};
}

}  // namespace svdag
