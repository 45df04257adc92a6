// The colours of a tile: one for each covered cube of a level inside the tile's cube.
//
// Idea: the page counts the nodes of the tile, as a look-up in the file does
// (io/dag/colours/colour_view.h). So the colours are an array without structure, depth first, and
// the tile's own bytes do not depend on them. Equal cubes have one tile but other colours, so a
// path names them, never the number of a tile in a folder. Rejected: the file's chunks (the means
// of coarse tiles are one colour in hundreds of each chunk), and a map from cells to colours.
#pragma once

#include <optional>
#include <vector>

#include "io/dag/colours/dag_colours.h"

namespace svdag {

// The largest that the page holds: 7 MiB. A tile with more cubes shows colours of a coarser level.
constexpr uint32_t kMaxTileColours = 1792 * 1024;

// The stored colours of the cubes of `level`, which is K, K-2, ..., in the cube of `path` (tile.h),
// as colour_at() gives them. Nothing for other levels, levels coarser than the cube, paths without
// a voxel, and more than `max_colours`.
std::optional<std::vector<uint32_t>> colours_of_tile(const DagColours& colours, uint64_t path,
                                                     uint32_t level,
                                                     uint32_t max_colours = kMaxTileColours);

// The level at which a tile of `tile_levels` levels has colours in the page, and these: the finest
// that exists and has room, if it is finer than `coarser`, that of the tiles above (0: none).
struct TileColours {
  uint32_t level;
  std::vector<uint32_t> colours;
};
std::optional<TileColours> colours_in_page(const DagColours& colours, uint64_t path,
                                           uint32_t tile_levels, uint32_t coarser = 0,
                                           uint32_t max_colours = kMaxTileColours);

}  // namespace svdag
