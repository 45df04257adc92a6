// The viewer's page and all tiles of a file as a folder, for any web server.
//
// Cubes with the same nodes have one tile: walls and interiors repeat, and most of a level's cubes
// with them. Tiles are numbered as a breadth-first walk from the grid meets them, so a file's
// folder does not depend on its layout. With colours, which differ where nodes repeat, each cube
// has a tile and its colours, named by its path as in a server (verify/view/server.h).
//
// index.html is written last: a folder that has it is complete. A run that was interrupted is
// continued: tiles that are there and valid are not cut again.
#pragma once

#include <string>
#include <vector>

#include "streaming/process/executor.h"
#include "streaming/process/progress.h"
#include "verify/view/page.h"

namespace svdag {

struct TileList {
  std::vector<TileCube> cubes;                 // [id - 1]
  std::vector<std::array<uint64_t, 8>> finer;  // [id - 1]: ids of the octants' tiles
  std::vector<uint64_t> paths;                 // [id - 1]: the names of tiles; empty: their ids
};

// All tiles that differ; `by_path`: of all cubes.
TileList list_tiles(const TileCutter& cutter, bool by_path = false);

// The tile of number `id`, as bytes.
std::string tile_of_list(const TileCutter& cutter, const TileList& list, uint64_t id);

// The size of all tiles and colours in bytes; from a sample of each level that has many.
// `colours`: of the file, if the tiles of `list` have paths; else null.
uint64_t estimate_bytes(const TileCutter& cutter, const TileList& list, const DagColours* colours,
                        Executor& executor);

// Writes the folder; creates it if it does not exist. Returns the bytes of tiles and colours. Error
// (kUsage) if the folder holds anything but those of this scene and the page.
uint64_t write_folder(const std::string& folder, const DagFile& file, const TileCutter& cutter,
                      const TileList& list, const DagColours* colours, int up, Executor& executor,
                      Progress& progress);

}  // namespace svdag
