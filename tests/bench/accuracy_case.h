// A case of the accuracy bench: a scene or family, a grid, and the cells that are voxelized.
//
// Every method gets the same cells and, per cell, the same candidates: the triangles whose box
// meets the cell grown by what a float coordinate of this scene may be off, so that a method that
// moves a triangle by many voxels still sees it. The judge (verify/) decides what is right,
// once, on the snapped triangles.
#pragma once

#include <string>
#include <vector>

#include "builder/octree/octree_cube.h"
#include "tests/bench/peers/cube_descent.h"

namespace svdag::bench {

struct CellWork {
  Cube cube;
  std::vector<Triangle> world;           // the candidates, as their file gives them
  std::vector<LatticeTriangle> snapped;  // the same, snapped to the lattice
  BrickList truth;                       // the judge's voxels
  uint64_t pairs = 0;                    // (triangle, voxel) that touch, by the judge
  uint64_t voxels = 0;                   // set in truth
};

struct Case {
  std::string name;
  std::string group;  // "scene", "family" or "bake"
  Grid grid;
  std::vector<CellWork> cells;
};

enum class Draw { kByArea, kByCount };

// Chooses `count` cells of 64 voxels a side (or, of a bake, the whole grid): each holds a random
// point of a random triangle. The same cells on every machine.
Case make_case(const std::string& name, const Grid& grid, const std::vector<Triangle>& triangles,
               int count, Draw draw);
Case make_bake(const std::string& name, const Grid& grid, const std::vector<Triangle>& triangles);

// The hard families of docs/accuracy.md, generated; no file is needed.
std::vector<Case> family_cases();
// The real scenes of `folder`.
std::vector<Case> scene_cases(const std::string& folder);
Case bake_case(const std::string& folder);

struct Difference {
  uint64_t misses = 0, extras = 0;
};
Difference compare(const BrickList& truth, const BrickList& found);

}  // namespace svdag::bench
