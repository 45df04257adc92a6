// The key of a cell: the BLAKE2b-256 hash of everything that determines its voxels.
//
// Hashed are the version of the algorithm, the rule, the cell's side and F, the selected box in the
// cell, and the triangles relative to the cell's corner, sorted and unique. For the solid rules,
// triangles count as often as they occur and with their orientation, and the winding number at the
// cell's reference point is hashed, too. The grid is not: the
// same geometry at another position, as an instance or in a grid that is moved by whole cells, has
// the same key. A listed triangle that misses the cell changes the key; the cell is then baked
// again, but never wrong. Collisions cannot be constructed (256 bits, cryptographic), so a cache
// can be shared. Rejected: a fast hash (the author of a scene could make two cells collide), keys
// of clipped triangles (clipping rounds, or needs rationals).
#pragma once

#include "builder/cache/cell_store.h"
#include "io/dag/format.h"
#include "io/grid.h"

namespace svdag {

CellKey cell_key(const Grid& grid, Rule rule, const Cube& cube, const TriangleList& list,
                 int32_t winding = 0);

}  // namespace svdag
