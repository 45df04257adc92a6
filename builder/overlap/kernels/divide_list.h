// Divides the triangle list of a cube among its eight children: one level of the octree descent.
//
// Used by the split (large triangles stay at inner nodes of the cell tree) and by the descent.
#pragma once

#include <array>

#include "builder/octree/octree_cube.h"
#include "builder/overlap/kernels/kernels.h"
#include "builder/overlap/triangle_list.h"

namespace svdag {

// Options that do not change the voxels; tests compare their results.
struct OverlapConfig {
  const Kernels* kernels = &svdag::kernels();
  bool covering = true;  // switch the edges of a triangle off where it covers a cube
};

// Fills children[c], cleared first, with the triangles of `list` that may touch child c of `cube`.
// `list` is the list of `cube`; `levels` is L of the grid.
void divide_list(const TriangleList& list, const Cube& cube, int levels,
                 const OverlapConfig& config, std::array<TriangleList, 8>* children);

}  // namespace svdag
