// Writes a `.svdag` level by level, deepest first, in one sequential pass.
//
// The levels arrive in canonical order (docs/format.md, "Order"), so the writer holds one block of
// 64 KiB and the checksum table. The file appears under its name only after finish().
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/brick.h"
#include "io/dag/format.h"
#include "io/grid.h"
#include "streaming/file/atomic_file.h"

namespace svdag {

// The children of a node: 0 = absent, otherwise 1 + the child's index (word or brick) one level
// down. Compared lexicographically, child 0 first: the canonical order.
using NodeKey = std::array<uint32_t, 8>;

class DagWriter {
 public:
  // `most_words`: of a section; tests ask for less than the format holds.
  DagWriter(const std::string& path, const Grid& grid, Rule rule, uint64_t most_words = kMaxWords);

  // Begins the section of `level`; the order is L-2, L-3, ..., 0, each exactly once.
  void begin_level(int level);
  // Appends a brick to level L-2, greater than the one before; returns its index. A full section is
  // an Error (kOutput).
  uint32_t add_brick(Brick brick);
  // Appends a node to an inner level, greater than the one before; returns its first word's index.
  uint32_t add_node(const NodeKey& children);
  // Writes metadata, checksums and header, and gives the file its name.
  void finish(uint64_t voxels, double largest_snap);

  const Header& header() const { return header_; }

 private:
  void append(const void* bytes, size_t size);
  void flush_block();
  void align();
  uint64_t position() const { return sizeof(Header) + written_ + block_.size(); }
  void close_level();

  AtomicFile file_;
  Header header_{};
  uint64_t most_words_;
  int level_;             // the level being written
  uint32_t words_ = 0;    // words (bricks) in it
  Brick last_brick_ = 0;  // the keys before, to assert their order
  NodeKey last_node_{};
  uint64_t written_ = 0;          // payload bytes in the file
  std::vector<std::byte> block_;  // payload bytes not yet written, less than kChecksumBlock
  std::vector<uint64_t> checksums_;
};

}  // namespace svdag
