// Tiles: a file cut into pieces that a browser loads and traces.
//
// Idea: levels of detail of an octree. The tile of a cube of level k shows its voxels divided T
// times, so at 2^T cells on a side, as a DAG of its own: the file's nodes of levels k to k + T,
// those that look alike at this depth merged. The tiles of its octants show each of them twice as
// fine. A level has about four times the nodes of the one above, so all tiles together are about
// 4/3 of the finest. Rejected: tiles that begin where others end (2^T octants per side, of which
// a view needs most); nodes loaded one by one (a request for each).
//
// Words of a tile's DAG, sections [depth], depth 0 .. T-2, all offsets in words from the begin of
// a section:
//
//   nodes, depth 0 .. T-3   child mask, then per present child, ascending, its offset in the next
//                           section
//   bricks, depth T-2       two words, the low one first: 4^3 cells as in the file
//
// In a file with layers, `layer_nodes` is an octree over the same cells, that ends where all cells
// of a cube are in the same layers. A value is kLayerSet + the number of a set of layers,
// kNoLayerSet where no cell is set, or else the offset of a node, which is 8 values.
//
// A tile is a function of the voxels and layers of its cube, not of the layout of the file:
// sections, layer nodes and sets are in the order in which a depth-first walk completes them.
//
// Rejected as well: tiles of 256^3 cells (requests and passes over the picture cost more than
// the bytes).
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "io/dag/dag_file.h"

namespace svdag {

constexpr uint32_t kTileLevels = 9;  // T, or the number of levels that are shown if it is less
constexpr uint32_t kLayerSet = 0x80000000U;
constexpr uint32_t kNoLayerSet = 0xffffffffU;

struct DagTile {
  std::vector<std::vector<uint32_t>> sections;  // [depth], T-1 of them
  uint32_t layer_root = kNoLayerSet;            // a value; kNoLayerSet without layers
  std::vector<uint32_t> layer_nodes;
  std::vector<std::vector<uint32_t>> layer_sets;  // [set]: layers, ascending
  std::array<uint64_t, 8> finer = {};  // ids of the tiles of the octants; 0: nothing finer to show
};

// A cube that has a voxel.
struct TileCube {
  struct LayerNode {
    uint32_t layer;  // kUnion: the file's union, or its only DAG
    uint32_t node;   // of level `level`
  };
  static constexpr uint32_t kUnion = 0xffffffffU;

  uint32_t level = 0;
  std::vector<LayerNode> nodes;  // that have a voxel in it, ascending by layer; kUnion is last
};

class TileCutter {
 public:
  // Shows the cubes of level `level`, 3 .. L, as cells. `max_tile_levels`: 3 or more; tests give
  // less, for small files with tiles of many levels. `file` must outlive this.
  TileCutter(const DagFile& file, uint32_t level, uint32_t max_tile_levels = kTileLevels);

  uint32_t levels() const { return level_; }
  uint32_t tile_levels() const { return tile_levels_; }
  // The grid; without nodes if nothing is set.
  TileCube root() const;
  // The octant c; without nodes if nothing is set in it.
  TileCube octant(const TileCube& cube, unsigned c) const;
  // Whether the octants have tiles.
  bool has_finer(const TileCube& cube) const { return cube.level + tile_levels() < level_; }
  // Whether all its voxels are set, by each layer that sets one: a finer tile shows no more.
  bool is_full(const TileCube& cube) const;
  // `finer` is left to the caller.
  DagTile cut(const TileCube& cube) const;

 private:
  class Cut;
  const DagView& view(const TileCube& cube, const TileCube::LayerNode& node) const;

  uint32_t level_, tile_levels_;
  DagView dag_;                  // of levels 1 and deeper, which all roots share
  std::vector<DagView> layers_;  // of level 0
  bool has_union_;
};

// The tile of a cube by its path: 1, then for each level the octant's three bits. 1 is the grid.
// Nothing for other paths.
std::optional<DagTile> tile_of_path(const TileCutter& cutter, uint64_t path);

}  // namespace svdag
