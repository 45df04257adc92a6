// Writes a `.svdag` file level by level, deepest first, in one sequential pass. The compact layout
// is then made from the plain one (io/dag/compact/compact_writer.h), which has no name.
//
// Nodes arrive in canonical order (docs/format.md, "Order"), so the writer holds only one block of
// 64 KiB and the checksum table. The file appears under its name only after finish().
//
// Rejected: checksums and writes on a thread of the writer (2 to 6 % of a merge, nothing of a
// bake).
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/brick.h"
#include "io/dag/dag_file.h"
#include "io/dag/layers/layer_table.h"
#include "io/dag/write/dag_file_output.h"
#include "io/dag/write/level_piece.h"
#include "io/dag/write/node_key.h"
#include "io/grid.h"
#include "streaming/spill/work_array.h"

namespace svdag {

class DagWriter {
 public:
  // The layout is compact if there is a room to make it in. `max_words`: limit of a section; tests
  // lower it.
  DagWriter(const std::string& path, const Grid& grid, Rule rule,
            std::optional<WorkRoom> compact = {}, uint64_t max_words = kMaxWords);

  // Begins the section of `level`; the order is L-2, L-3, ..., 0, each exactly once.
  void begin_level(int level);
  // Appends a brick to level L-2 and returns its index. Bricks must ascend. A full section is an
  // Error (kOutput).
  uint32_t add_brick(Brick brick);
  // Appends a node to an inner level and returns the index of its first word. Nodes must ascend. A
  // full section is an Error (kOutput).
  uint32_t add_node(const NodeKey& children);
  // The same for many keys of the level (io/dag/write/level_piece.h): encode() adds bricks of level
  // L-2 or nodes of another to *piece, append() returns the index of its first key, store()
  // completes it. One thread at a time appends; any may encode and store.
  void encode(std::span<const Brick> bricks, LevelPiece* piece) const;
  void encode(std::span<const NodeKey> nodes, LevelPiece* piece) const;
  // Nodes of a level below the roots: their masks, and the children of all as in their keys,
  // followed by 8 zeros. They ascend; *piece must be empty.
  void encode(std::span<const unsigned char> masks, std::span<const uint32_t> children,
              LevelPiece* piece) const;
  uint32_t append(LevelPiece* piece);
  void store(LevelPiece* piece) { output_.store(&piece->filled); }
  // The roots, that is, the nodes of level 0, may come in any order; add_node() numbers them.
  //
  // Writes metadata, checksums and header, and renames the file to its name. Without layers there
  // is one root at most, and `voxels` is its number (with layers, the union's); roots of the table
  // are what add_node() returned, its layers in any order. `check` may throw: then the file gets no
  // name.
  void finish(uint64_t voxels, double largest_snap, LayerTable layers = {},
              const std::function<void(const Header&)>& check = {});
  // The same, but the file gets no name and is in the plain layout; errors show `shown_as`.
  DagFile finish_unnamed(uint64_t voxels, double largest_snap, LayerTable layers,
                         const std::string& shown_as);

  const Header& header() const { return header_; }

 private:
  void close_level();

  void begin_key(const NodeKey& key);
  uint32_t take_words(uint64_t words, uint64_t nodes);
  uint32_t append_node(const NodeKey& children);
  void write_roots(LayerTable* layers);
  void write_layers(LayerTable layers);
  void complete(uint64_t voxels, double largest_snap, LayerTable layers);

  std::string path_;
  std::optional<WorkRoom> compact_;
  DagFileOutput output_;
  Header header_{};
  uint64_t max_words_;
  int level_;                   // the level being written
  uint32_t words_ = 0;          // words (bricks) in it
  NodeKey last_{};              // its last key
  std::vector<NodeKey> roots_;  // level 0
};

}  // namespace svdag
