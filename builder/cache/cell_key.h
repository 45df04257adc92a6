// The key of a cell: BLAKE2b-256 of all that decides its voxels.
//
// That is the version of the algorithm, the rule, the cell's side and F, the part of the cell that
// may be set, and the triangles relative to the cell's corner, sorted, each once. Not the grid: the
// same geometry in another place, of an instance or in a grid that was moved by whole cells, has
// the same key. A triangle that is listed though it misses the cell changes the key, which costs a
// bake of the cell and never a wrong one. Keys of different content are different for all that
// anybody can do (256 bits, cryptographic), so a cache can be shared.
// Rejected: a fast hash (whoever writes scenes could make two cells collide), keys of clipped
// triangles (clipping rounds, or needs rationals).
#pragma once

#include "builder/cache/cell_store.h"
#include "io/dag/format.h"
#include "io/grid.h"

namespace svdag {

CellKey cell_key(const Grid& grid, Rule rule, const Cube& cube, const TriangleList& list);

}  // namespace svdag
