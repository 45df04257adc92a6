// The lists that go down the octree: which triangles a cube has to ask, and what of them.
#pragma once

#include <vector>

#include "builder/overlap/triangle_setup.h"

namespace svdag {

// One triangle in the list of a cube that it (very likely) touches, with the edge functions that do
// not yet hold everywhere in the cube. An edge that holds in a cube holds in all its parts, so it
// is switched off for good.
struct ListedTriangle {
  const TriangleSetup* triangle;
  EdgeMask edges;
};
using TriangleList = std::vector<ListedTriangle>;

}  // namespace svdag
