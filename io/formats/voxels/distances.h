// Distances from the voxels of a window to the nearest set voxel, up to a limit: the exact
// Euclidean distance transform, axis by axis (Saito and Toriwaki 1994).
//
// The square of the distance between the middles of two voxels is an integer. With S the set
// voxels, N the limit and all offsets i, j, k in -N .. N,
//   D(x, y, z) = min_i (i^2 + min_j (j^2 + min_k k^2)),  (x+i, y+j, z+k) in S,
// is the least square wherever it is at most N^2, since then no offset of the nearest voxel exceeds
// N. Set voxels outside of the window count; outside of the grid there are none.
//
// Of a solid, a set voxel has minus the distance to the nearest voxel that is not set: the
// transform of the complement. Distances of two neighbours on the two sides of a surface are 1 and
// -1.
//
// Invariant: D is computed per tile of at most 64^3 voxels with a border of N, so memory is that of
// a tile, and of the planes of tiles that are written in order. Squares, also those of no voxel,
// fit in 16 bits, so minima are taken eight at a time. Rows without a set voxel are passed over.
// Rejected: lower envelopes (Felzenszwalb and Huttenlocher): their time does not depend on N, but
// they decide voxel by voxel, and N is small.
#pragma once

#include <cstdint>
#include <string>

#include "io/formats/window.h"
#include "streaming/memory/memory_budget.h"

namespace svdag {

constexpr int kMaxDistance = 64;  // largest N

struct DistanceConfig {
  int limit = 8;           // N, in voxels, 1 .. kMaxDistance; larger distances are written as N
  bool is_signed = false;  // of a solid
};

// Writes a NumPy archive: `distance` (nx x ny x nz, float32, in voxels: square roots of integers),
// `corner` (3 x float64, world position of the corner of its first voxel), `voxel_size` (float64)
// and `limit` (float64). Returns the number of distances.
uint64_t write_distances(const VoxelWindow& window, const DistanceConfig& config,
                         MemoryBudget* budget, const std::string& path);

}  // namespace svdag
