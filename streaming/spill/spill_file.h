// A file of framed blocks: where a bake puts what does not fit in memory.
//
// A *stream* is a sequence of bytes with a number of its own. Its blocks are anywhere in the
// file, so hundreds of streams grow at once in one file, and the blocks of a stream that was freed
// are used again. Every block has the same size and begins with
//
//   magic u32, length u32 (payload bytes), stream u64, index u64 (of the block in its stream),
//   checksum u64 (XXH3-64 of the whole block, with zeros here), zeros up to 64 bytes
//
// and the last block of a stream is filled up with zeros, so that a flipped bit, a stale block and
// a block of another stream or place are all found (SpoiledScratch: "scratch file is damaged"). The
// file is opened with O_DIRECT where the system has it: spilled bytes are used once, long after
// they were written, and would only push the rest out of the page cache. Reading ahead and writing
// behind run on one thread of the file, so that disk and processor overlap. Rejected: a file per
// stream (thousands of descriptors), mmap (SIGBUS, and no account of memory), checksums per stream
// (found too late).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/spill/block_source.h"
#include "streaming/spill/spill_block.h"

namespace svdag {

struct SpillStream {
  uint64_t number = 0;           // never used twice in one scratch folder
  uint64_t bytes = 0;            // payload
  std::vector<uint32_t> blocks;  // positions of the blocks, in order
};

class SpillFile {
 public:
  static constexpr size_t kHeader = kSpillHeader;

  // `block_bytes`, header included: a multiple of 4096. `first_free`: blocks before this one are in
  // use already (a file that is resumed). `damaged`: the code of the Error about a damaged block;
  // kBadInput for files other than scratch.
  SpillFile(File file, size_t block_bytes, uint32_t first_free = 0,
            ExitCode damaged = ExitCode::kOutput);
  ~SpillFile();

  size_t block_bytes() const;
  // Payload bytes of a full block: a multiple of 64.
  size_t payload_bytes() const { return block_bytes() - kHeader; }
  // Waits for all writes and brings them to disk; a write that failed before is thrown here, too.
  void sync();
  // Syncs, and gives an anonymous file the name `path` (File::link_as).
  void link_as(const std::string& path);
  // The blocks of `stream` may be used for others. No reader of it may be alive.
  void free(const SpillStream& stream);
  // Largest size of the file so far, and all that was written to it and read from it.
  uint64_t peak_bytes() const;
  uint64_t written_bytes() const;
  uint64_t read_bytes() const;

 private:
  friend class SpillWriter;
  friend class SpillReader;
  friend class SpillFetch;
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// Appends to one stream. Holds one block from its first byte on; the writers of a file share spare
// blocks for what is being written, at most one for each writer and four in all, and none where the
// budget has no room (the writer waits for the disk instead). Streams of one file may be written
// and read by different threads at once; a writer or reader itself is for one, and dies before the
// file does. A write that failed fails all that is done with the file afterwards.
class SpillWriter {
 public:
  SpillWriter(SpillFile* file, uint64_t stream, MemoryBudget* budget);
  SpillWriter(SpillWriter&&) noexcept;
  SpillWriter& operator=(SpillWriter&&) noexcept;
  ~SpillWriter();  // without finish(): the stream's blocks are freed

  void append(std::span<const std::byte> bytes);
  uint64_t bytes() const;
  // Writes the last block. It is readable at once, and durable after SpillFile::sync(). The memory
  // goes back to the budget when the writer dies, which waits for that block.
  SpillStream finish();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// Reads one stream, a block ahead. Holds two blocks, one if there is but one.
class SpillReader : public BlockSource {
 public:
  // `stream` is copied. Begins with block `first` of the stream.
  SpillReader(SpillFile* file, const SpillStream& stream, MemoryBudget* budget, size_t first = 0);
  SpillReader(SpillReader&&) noexcept;
  SpillReader& operator=(SpillReader&&) noexcept;
  ~SpillReader() override;

  std::span<std::byte> next() override;
  // The Error about a damaged block: for who finds that what is in one makes no sense.
  [[noreturn]] void fail_damaged() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

// Reads one block of a stream, in any order: requested by the constructor, available after wait().
// take_block() returns the memory.
class SpillFetch {
 public:
  SpillFetch(SpillFile* file, const SpillStream& stream, size_t index, SpillBlock block);
  SpillFetch(SpillFetch&&) noexcept;
  ~SpillFetch();

  // The payload. Aligned to 64 bytes. To be called once.
  std::span<std::byte> wait();
  // The memory, when the payload is no longer needed.
  SpillBlock take_block();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace svdag
