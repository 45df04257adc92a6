// Diagnostics of a scene as a mesh, for `svdag info`: shared, degenerate and open elements.
//
// Positions are compared as float32, the precision in which scenes are stored: instances of one
// vertex that differ by an ulp of double arithmetic are equal. Where coordinates exceed 1e5 the
// rounded mean of all corners is subtracted first, in double, so that city coordinates keep their
// millimetres. The same holds for an axis where they are twice as far from 0 as from each other;
// there the rest is rounded to the last bit of a float as large as the scene, because floats near 0
// resolve the rounding errors of doubles. On these floats every result is exact.
// Rejected: a halfedge mesh, which cannot hold non-manifold edges at all.
#pragma once

#include <cstdint>

#include "io/scene/scene.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

struct MeshStats {
  uint64_t triangles = 0;
  uint64_t positions = 0;  // distinct
  uint64_t repeated = 0;   // triangles with two corners at one position
  uint64_t zero_area = 0;  // triangles of exactly zero area, including the repeated
  // Of the triangles with three different corners:
  uint64_t duplicates = 0;          // beyond the first with the same three positions
  uint64_t open_edges = 0;          // used by one triangle
  uint64_t non_manifold_edges = 0;  // used by more than two
  uint64_t components = 0;          // connected through shared positions

  bool operator==(const MeshStats&) const = default;
};

// Reads the scene three times; takes 12 to 24 bytes per position and 36 per triangle of `budget`.
MeshStats compute_mesh_stats(const Scene& scene, MemoryBudget* budget);

}  // namespace svdag
