// A file of checksummed blocks for data that does not fit in memory.
//
// A *stream* is a sequence of bytes with a unique number. Its blocks may be anywhere in the file,
// so hundreds of streams can grow in one file at once, and the blocks of a freed stream are reused.
// Every block has the same size and begins with
//
//   magic u32, length u32 (payload bytes), stream u64, index u64 (of the block in its stream),
//   checksum u64 (XXH3-64 of the whole block, with zeros here), zeros up to 64 bytes
//
// The last block of a stream is filled with zeros. A flipped bit, a stale block, and a block of
// another stream or index are all detected (InvalidScratch: "scratch file is damaged"). The file is
// opened with O_DIRECT where the file system supports it: spilled bytes are read once, long after
// they were written, and would only evict other data from the page cache. Read-ahead and
// write-behind run on one I/O thread per file, so that disk and processor overlap.
// Rejected: a file per stream (thousands of descriptors), mmap (SIGBUS, memory not counted),
// checksums per stream (damage is found too late).
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "streaming/file/file.h"
#include "streaming/memory/memory_budget.h"
#include "streaming/spill/spill_block.h"
#include "streaming/spill/spill_queue.h"

namespace svdag {

struct SpillStream {
  uint64_t number = 0;           // never reused in one scratch folder
  uint64_t bytes = 0;            // payload bytes
  std::vector<uint32_t> blocks;  // positions of its blocks in the file, in blocks
};

class SpillFile {
 public:
  static constexpr size_t kHeader = kSpillHeader;

  // `block_bytes`: size of a block with its header, a multiple of 4096. `first_free`: position from
  // which on no block is in use (for a resumed file). `damaged`: exit code for a damaged block;
  // kBadInput for files other than scratch.
  SpillFile(File file, size_t block_bytes, uint32_t first_free = 0,
            ExitCode damaged = ExitCode::kOutput);

  size_t block_bytes() const { return block_bytes_; }
  // Payload bytes of a full block: a multiple of 64.
  size_t payload_bytes() const { return block_bytes_ - kHeader; }
  // Waits for all writes and makes them durable. Throws the error of a write that has failed.
  void sync() { queue_.sync(); }
  // sync(), then File::link_as(path).
  void link_as(const std::string& path) { queue_.link_as(path); }
  // Allows the reuse of the stream's blocks, from first to last. The stream must have no reader.
  // Does not throw, for destructors: without memory for the list they are not reused.
  void free(const SpillStream& stream) noexcept;
  // Largest size of the file so far, and total bytes written and read, with headers.
  uint64_t peak_bytes() const;
  uint64_t written_bytes() const { return queue_.written_bytes(); }
  uint64_t read_bytes() const { return queue_.read_bytes(); }

 private:
  friend class SpillWriter;
  friend class SpillReader;
  friend class SpillFetch;

  uint32_t allocate();
  // Waits for a read; throws its error.
  void wait(SpillTransfer* read);
  // Checks a block that was read and returns its payload. Done by the thread that uses the block,
  // not by the I/O thread, so that the block is in its cache.
  std::span<std::byte> open(const SpillBlock& block, const SpillStream& stream,
                            uint64_t index) const;
  [[noreturn]] void fail_damaged() const;

  const size_t block_bytes_;
  SpillQueue queue_;
  mutable std::mutex mutex_;
  std::vector<uint32_t> free_;
  uint32_t end_;  // position from which on no block has been used
  ExitCode damaged_;
};

// Appends to one stream.
//
// Takes the memory of one block at the first byte. While blocks are being written, the writers of a
// file share spare blocks: at most one per writer and four per file, and none if the budget has no
// room (the writer then waits for the disk). Different threads may write and read streams of one
// file at once, but each writer or reader belongs to one thread at a time, and the file must
// outlive it. After a failed write, all operations on the file throw its error.
class SpillWriter {
 public:
  SpillWriter(SpillFile* file, uint64_t stream, MemoryBudget* budget);
  SpillWriter(SpillWriter&&) noexcept = default;
  ~SpillWriter();  // without finish(): frees the stream's blocks

  // Errors: kOutput if writing fails, kMemory if the budget has no room for one block.
  void append(std::span<const std::byte> bytes);
  // Bytes appended so far.
  uint64_t bytes() const { return stream_.bytes; }
  // Writes the last block and returns the stream, which can be read at once and is durable after
  // SpillFile::sync(). The destructor waits for the last block and releases the memory.
  SpillStream finish();

 private:
  void write_full();
  void write(SpillTransfer* transfer);

  SpillFile* file_;
  MemoryBudget* budget_;
  SpillStream stream_;
  std::unique_ptr<SpillTransfer> own_;  // the block that is being filled; null if moved from
  size_t filled_ = 0;                   // payload bytes in it
  bool finished_ = false;
};

// Reads one stream, one block ahead. Takes the memory of two blocks, or one for a single block.
class SpillReader : public BlockSource {
 public:
  // Reads `stream`, which is copied, from its block `first` (0 .. number of blocks) on.
  SpillReader(SpillFile* file, const SpillStream& stream, MemoryBudget* budget, size_t first = 0);
  SpillReader(SpillReader&&) noexcept = default;
  ~SpillReader() override;

  std::span<std::byte> next() override;
  // Throws the Error for a damaged block: for callers that find invalid content in one.
  [[noreturn]] void fail_damaged() const { file_->fail_damaged(); }

 private:
  void request();

  SpillFile* file_;
  MemoryBudget* budget_;
  SpillStream stream_;
  size_t index_;                          // of the requested block
  SpillBlock current_;                    // returned by next()
  std::unique_ptr<SpillTransfer> ahead_;  // null if moved from
};

// Reads block `index` of a stream into the memory of `block`. The constructor starts the read; the
// payload is available after wait().
class SpillFetch {
 public:
  SpillFetch(SpillFile* file, const SpillStream& stream, size_t index, SpillBlock block);
  SpillFetch(const SpillFetch&) = delete;
  ~SpillFetch();

  // Waits for the read and returns the payload, aligned to 64 bytes. To be called once.
  std::span<std::byte> wait() {
    file_->wait(&transfer_);
    return file_->open(transfer_.block, stream_, index_);
  }
  // Returns the memory for reuse; invalidates the payload.
  SpillBlock take_block();

 private:
  SpillFile* file_;
  SpillStream stream_;  // without the list of its blocks
  uint64_t index_;
  SpillTransfer transfer_;
};

}  // namespace svdag
