// The rules, as a table: everything in which the voxels that triangles set differ from rule to
// rule. A new rule is a row in rules.cpp and a file with its kernel.
//
// A solid rule sets the voxels of its surface rule and those whose winding number is inside
// (is_solid() and is_inside() in io/dag/format.h).
#pragma once

#include "builder/overlap/kernels/kernels.h"
#include "builder/overlap/lattice_plane.h"
#include "io/dag/format.h"

namespace svdag {

struct SurfaceRule {
  Rule rule;
  RuleKernels Kernels::*kernels;
  // The offsets of a plane with the normal n (builder/overlap/lattice_plane.h) for which it sets
  // the voxel at the corner; `fraction` is F of the grid.
  OffsetRange (*voxel_offsets)(const int64_t n[3], int fraction);
  // Whether a plane sets exactly one voxel in each column along its dominant axis.
  bool is_one_per_column;
  const char* self_test_hash;  // of the voxels of builder/descend/self_test.h
};

// How triangles set voxels under `rule`.
const SurfaceRule& surface_rule(Rule rule);

}  // namespace svdag
