// The location of the sub-DAG of a cube: a root of a run, or a top of a grid part; and the set of
// voxels that it is of.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag {

// The sets of voxels of a bake with layers: the union of all, and each layer. A bake without layers
// has the union alone.
//
// A *subject* names the sets that a sub-DAG is of. In a cube that triangles of one layer alone
// touch, the layer's set is the union's, so they share the sub-DAG; elsewhere each has its own.
using Subject = uint32_t;
constexpr Subject kUnionSet = 0;
constexpr Subject kApart = 0x80000000U;  // with a layer: not the union's
// Layer `layer` (from 0), and the union where no other layer is.
constexpr Subject subject_of(uint32_t layer) {
  return 1 + layer;
}
constexpr bool has_layer(Subject subject) {
  return (subject & ~kApart) != 0;
}
constexpr uint32_t layer_of(Subject subject) {
  return (subject & ~kApart) - 1;
}
constexpr bool has_union(Subject subject) {
  return (subject & kApart) == 0;
}

// Whether a triangle counts alike for the windings of its layer and of the union (io/triangle.h).
constexpr bool is_sheet_of_both_or_none(uint32_t sheet) {
  return (sheet & kSheetOfUnion) * kSheetOfLayer == (sheet & kSheetOfLayer);
}

// Node `rank` of the cube's level in run `run`. The cube is a cell, a cube in a cell in which a
// node table was emptied, or a top of a grid part.
struct SubDagRoot {
  uint64_t morton;  // of the cube, at its level
  int32_t level;
  uint32_t run;
  uint32_t rank;
  Subject subject = kUnionSet;
};

}  // namespace svdag
