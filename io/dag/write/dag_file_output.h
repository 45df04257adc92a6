// The bytes of a `.svdag` file from the header's end on, written in order: blocks with checksums,
// then the metadata, the checksum table, and the header.
#pragma once

#include <span>
#include <string>

#include "io/dag/format.h"
#include "streaming/file/atomic_file.h"
#include "streaming/file/block_filler.h"

namespace svdag {

class DagFileOutput {
 public:
  explicit DagFileOutput(const std::string& path);

  void append(std::span<const std::byte> bytes);
  // Blocks that append() of `blocks()` filled. Thread-safe.
  void store(FilledBlocks* filled);
  BlockFiller* blocks() { return &blocks_; }
  // Appends zeros up to the alignment of sections.
  void align();
  // Of the next byte, in the file.
  uint64_t position() const { return sizeof(Header) + blocks_.position(); }

  // Writes what follows the last part, and *header with the places, checksums and hashes. The
  // content hash is computed unless the table has a hash of its own (has_table_hash()).
  void finish(Header* header);
  // Then gives the file its name.
  void commit() { file_.commit(); }
  std::string open_name() const { return file_.open_name(); }

 private:
  AtomicFile file_;
  BlockFiller blocks_{kChecksumBlock};
  FilledBlocks filled_;  // by append()
};

}  // namespace svdag
