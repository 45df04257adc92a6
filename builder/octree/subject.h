// Which set of voxels something is of: a triangle, a winding number, a sub-DAG.
//
// A bake with layers has a set for the union of all layers and one for each layer. A bake without
// layers has only the union.
#pragma once

#include <cstdint>

#include "io/triangle.h"

namespace svdag {

// Names one set: the union, or a layer. A triangle of a bake with layers names its layer.
using Subject = uint32_t;
constexpr Subject kUnionSet = 0;
constexpr Subject subject_of(uint32_t layer) {
  return 1 + layer;
}
constexpr bool is_layer(Subject subject) {
  return subject != kUnionSet;
}
constexpr uint32_t layer_of(Subject subject) {
  return subject - 1;
}

// The sets that have a sub-DAG in common. In a cube that only one layer touches, the layer's voxels
// are the union's, so both have the same sub-DAG; elsewhere each set has its own.
struct SubDagSets {
  Subject subject = kUnionSet;
  bool in_union = true;  // also the union's; always true if `subject` is the union

  static constexpr SubDagSets only(Subject subject) { return {subject, subject == kUnionSet}; }
  // Of `subject` and the union.
  static constexpr SubDagSets with_union(Subject subject) { return {subject, true}; }
};

// Whether a triangle counts alike for the windings of its layer and of the union (io/triangle.h).
constexpr bool is_sheet_of_both_or_none(uint32_t sheet) {
  return (sheet & kSheetOfUnion) * kSheetOfLayer == (sheet & kSheetOfLayer);
}

}  // namespace svdag
