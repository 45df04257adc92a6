// Triangle lists of octree cubes: the triangles that may touch a cube, with their undecided edges.
#pragma once

#include <vector>

#include "builder/overlap/triangle_setup.h"

namespace svdag {

// A triangle in the list of a cube that it (very likely) touches, with the edge functions that do
// not hold everywhere in the cube. An edge function that holds in a cube holds in all of its
// sub-cubes, so it stays off below.
struct ListedTriangle {
  const TriangleSetup* triangle;
  EdgeMask edges;
};
using TriangleList = std::vector<ListedTriangle>;

}  // namespace svdag
