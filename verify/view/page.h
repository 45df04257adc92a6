// The viewer's page: its files, part of the program, and what it knows of a scene.
//
// The page loads `scene.json` and `tiles/ID` beside it, so a server and a folder of files look the
// same to it. The report holds all of it in one text.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "verify/view/tile.h"
#include "verify/view/tile_colours.h"

namespace svdag {

struct PageFile {
  std::string_view name;  // "view.js"
  std::string_view type;  // "text/javascript"
  std::string_view text;
};

// index.html is the last.
std::span<const PageFile> page_files();

struct SceneOfPage {
  int up = 1;                 // axis
  uint64_t root = 1;          // id of the tile of the grid
  bool served = false;        // the page keeps a request open while it is shown
  uint32_t colour_level = 0;  // K, if tiles have colours (tile_colours.h)
  uint32_t max_colours = kMaxTileColours;
  bool root_colours = false;  // only the root has some
};

// The scene as JSON, without "<", so that a page can hold it.
std::string scene_json(const DagFile& file, const TileCutter& cutter, const SceneOfPage& options);

// The scripts of the page as one, which ends with the definition of start().
std::string joined_scripts();

}  // namespace svdag
