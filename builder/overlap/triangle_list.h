// Triangle lists of octree cubes: the triangles that may touch a cube, with their undecided edges.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "builder/octree/subject.h"
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

// Whether all triangles of a list that is grouped by layer are of one layer. In a bake with layers
// all lists are grouped.
inline bool is_of_one_layer(const TriangleList& list) {
  return list.empty() ||
         list.front().triangle->triangle.subject == list.back().triangle->triangle.subject;
}
inline bool has_cuts(std::span<const ListedTriangle> list) {
  return std::ranges::any_of(
      list, [](const ListedTriangle& entry) { return entry.triangle->triangle.cut != 0; });
}
// The subject of a list of one layer.
inline Subject subject_of(const TriangleList& list) {
  return list.empty() ? kUnionSet : list.front().triangle->triangle.subject;
}

}  // namespace svdag
