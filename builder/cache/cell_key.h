// The key of a cell: BLAKE2b-256 of everything that determines its voxels.
//
// That is the version of the algorithm, the rule, the cell's side and F, the part of the cell that
// may be set, and the triangles relative to the cell's corner, sorted, without duplicates. Not the
// grid: the same geometry elsewhere, in an instance or in a grid that moved by whole cells, has the
// same key. A listed triangle that misses the cell changes the key, which costs a bake of the cell
// but never gives a wrong one. The hash is cryptographic, so no scene can be made to collide with
// another one, and a cache can be shared.
// Rejected: a fast hash (a scene's author could make two cells collide), keys of clipped triangles
// (clipping rounds, or needs rationals).
#pragma once

#include "builder/cache/cell_store.h"
#include "io/dag/format.h"
#include "io/grid.h"

namespace svdag {

CellKey cell_key(const Grid& grid, Rule rule, const Cube& cube, const TriangleList& list);

}  // namespace svdag
