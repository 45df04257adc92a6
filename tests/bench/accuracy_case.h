// A case of the accuracy bench: a scene or family, a grid, and the cells that are voxelized.
//
// Every method gets the same cells and candidates. The candidates of a cell are the triangles whose
// box meets the cell, enlarged by the rounding error of float coordinates in the scene, so that a
// method that displaces a triangle by many voxels still gets it. The judge (verify/) decides the
// right voxels once, on the snapped triangles.
#pragma once

#include <string>
#include <vector>

#include "builder/octree/octree_cube.h"
#include "tests/bench/peers/cube_descent.h"

namespace svdag::bench {

struct CellWork {
  Cube cube;
  std::vector<Triangle> world;           // the candidates, as stored in the file
  std::vector<LatticeTriangle> snapped;  // the candidates, snapped to the lattice
  BrickList truth;                       // the judge's voxels
  uint64_t pairs = 0;                    // touching (triangle, voxel) pairs, by the judge
  uint64_t voxels = 0;                   // number of voxels in `truth`
};

struct Case {
  std::string name;
  std::string group;  // "scene", "family" or "bake"
  Grid grid;
  std::vector<CellWork> cells;
};

enum class Draw { kByArea, kByCount };

// A case of `count` cells of 64^3 voxels, each with a random point of a random triangle. The cells
// are the same on every machine.
Case make_case(const std::string& name, const Grid& grid, const std::vector<Triangle>& triangles,
               int count, Draw draw);
// A case of one cell: the whole grid.
Case make_bake(const std::string& name, const Grid& grid, const std::vector<Triangle>& triangles);

// The generated families of docs/accuracy.md, which need no file.
std::vector<Case> family_cases();
// The real scenes in `folder`.
std::vector<Case> scene_cases(const std::string& folder);
Case bake_case(const std::string& folder);

struct Difference {
  uint64_t misses = 0, extras = 0;
};
Difference compare(const BrickList& truth, const BrickList& found);

}  // namespace svdag::bench
