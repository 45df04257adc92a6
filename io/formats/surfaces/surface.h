// The surface of the set voxels of a window: the faces between a set voxel and one that is not, or
// that is outside, as quads whose corners run counterclockwise seen from outside.
//
// Faces are found and merged within cubes of 64^3 voxels ("tiles"), so what a tile gives depends on
// its voxels and those beside it alone: memory is that of a tile, and the order and the quads are
// canonical. Notation, per tile: rows[x + 1][y + 1] has a bit z for each voxel, with a border of
// one row around; a plane holds the 64 x 64 faces of one direction and depth, as 64 rows of bits.
// Faces of a direction are a row without the row beside it. A plane is merged greedily: the first
// face in rows and bits, with those that follow it in its row, then with further rows that have all
// of these. Faces of different colours are not merged.
//
// The surface is closed: each point of each line is passed as often in one direction as in the
// other (io/scene/boundary_chain.h). Merged quads meet at T-junctions, which lie exactly on the
// longer edge; without merging, edges match one by one. Where two set voxels share only an edge,
// four faces meet at it.
// Rejected: merging across tiles (order, memory and threads would decide), and the optimum of
// fewest rectangles (a matching per plane, for a few percent).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "io/formats/window.h"

namespace svdag {

struct SurfaceConfig {
  bool merge = true;    // false: a quad for each face
  bool colours = true;  // of the window, if it has some
};

// The quads of a tile.
struct SurfaceTile {
  struct Vertex {
    std::array<int32_t, 3> at;  // voxel planes of the grid
    Colour colour;              // of its quads
  };
  std::vector<Vertex> vertices;                // each once
  std::vector<std::array<uint32_t, 4>> quads;  // of vertices
};

struct SurfaceCounts {
  uint64_t voxels = 0;
  uint64_t faces = 0;  // of voxels
  uint64_t quads = 0, vertices = 0;
};

using SurfaceSink = std::function<void(const SurfaceTile&)>;

// Passes the tiles that have faces to the sink, in Morton order but for those in large full cubes,
// which are passed when the walk meets the cube.
SurfaceCounts visit_surface(const VoxelWindow& window, const SurfaceConfig& config,
                            const SurfaceSink& sink);

}  // namespace svdag
