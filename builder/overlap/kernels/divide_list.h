// Divides the triangle list of a cube among its eight children: one step of the octree descent.
//
// Shared by the split (large triangles are kept at inner nodes of the cell tree) and the descent.
#pragma once

#include <array>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/kernels/kernels.h"
#include "builder/overlap/triangle_list.h"

namespace svdag {

// Alternatives that give the same voxels; tests compare them.
struct OverlapConfig {
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;  // switch the edges of a triangle off where it covers a cube
};

// Fills children[c] with the triangles of `list`, the list of `cube`, that child c may touch.
// `levels`: L of the grid. Clears the children first.
void divide_list(const TriangleList& list, const Cube& cube, int levels,
                 const OverlapConfig& config, std::array<TriangleList, 8>* children);

}  // namespace svdag
