#include "streaming/spill/spill_file.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <utility>

#include "streaming/error.h"
#include "streaming/spill/invalid_scratch.h"
#include "streaming/spill/spill_queue.h"

namespace svdag {

// The I/O queue and the list of free blocks.
class SpillFile::Impl {
 public:
  Impl(File file, size_t bytes, uint32_t first_free, ExitCode damaged)
      : block_bytes(bytes), queue(std::move(file), bytes), end_(first_free), damaged_(damaged) {
    SVDAG_ASSERT(bytes > 0 && bytes % SpillBlock::kAlignment == 0);
  }

  uint32_t allocate() {
    const std::lock_guard lock(mutex_);
    if (free_.empty()) {
      if (end_ == UINT32_MAX)
        throw Error(ExitCode::kOutput, "a scratch file cannot hold more than 2^32 - 1 blocks",
                    queue.path());
      return end_++;
    }
    const uint32_t position = free_.back();
    free_.pop_back();
    return position;
  }

  // The blocks are later reused from first to last. Does not throw, for destructors: without memory
  // for the list they are not reused.
  void free(const std::vector<uint32_t>& blocks) noexcept {
    const std::lock_guard lock(mutex_);
    try {
      free_.insert(free_.end(), blocks.rbegin(), blocks.rend());
    } catch (const std::bad_alloc&) {
    }
  }

  uint64_t peak_bytes() const {
    const std::lock_guard lock(mutex_);
    return uint64_t(end_) * block_bytes;
  }

  // Checks a block that was read and returns its payload.
  std::span<std::byte> open(const SpillBlock& block, const SpillStream& stream, uint64_t index) {
    const uint64_t payload = block_bytes - kHeader;
    const uint32_t length = uint32_t(std::min<uint64_t>(payload, stream.bytes - index * payload));
    if (!open_block(block.bytes(), {stream.number, index, length})) fail_damaged();
    return block.bytes().subspan(kHeader, length);
  }
  [[noreturn]] void fail_damaged() const {
    if (damaged_ == ExitCode::kBadInput)
      throw Error(damaged_, "is damaged: create it again", queue.path());
    throw InvalidScratch(damaged_, "scratch file is damaged", queue.path());
  }

  const size_t block_bytes;
  SpillQueue queue;

 private:
  mutable std::mutex mutex_;
  std::vector<uint32_t> free_;
  uint32_t end_;  // position from which on no block has been used
  ExitCode damaged_;
};

SpillFile::SpillFile(File file, size_t block_bytes, uint32_t first_free, ExitCode damaged)
    : impl_(std::make_unique<Impl>(std::move(file), block_bytes, first_free, damaged)) {}
SpillFile::~SpillFile() = default;

size_t SpillFile::block_bytes() const {
  return impl_->block_bytes;
}

void SpillFile::sync() {
  impl_->queue.sync();
}

void SpillFile::link_as(const std::string& path) {
  impl_->queue.link_as(path);
}

void SpillFile::free(const SpillStream& stream) {
  impl_->free(stream.blocks);
}

uint64_t SpillFile::peak_bytes() const {
  return impl_->peak_bytes();
}

uint64_t SpillFile::written_bytes() const {
  return impl_->queue.written_bytes();
}

uint64_t SpillFile::read_bytes() const {
  return impl_->queue.read_bytes();
}

class SpillWriter::Impl {
 public:
  Impl(SpillFile* file, uint64_t number, MemoryBudget* budget)
      : file_(file->impl_.get()), payload_(file->payload_bytes()), budget_(budget) {
    stream_.number = number;
    file_->queue.enter_writer();
  }

  ~Impl() {
    file_->queue.wait(&own_);
    file_->queue.leave_writer();
    if (!finished_) file_->free(stream_.blocks);
  }

  void append(std::span<const std::byte> bytes) {
    SVDAG_ASSERT(!finished_);
    file_->queue.check();
    while (!bytes.empty()) {
      if (!own_.block) own_.block = SpillBlock(budget_, file_->block_bytes);
      const size_t n = std::min(bytes.size(), payload_ - filled_);
      std::memcpy(own_.block.bytes().data() + SpillFile::kHeader + filled_, bytes.data(), n);
      bytes = bytes.subspan(n);
      filled_ += n;
      stream_.bytes += n;
      if (filled_ == payload_) write_full();
    }
  }

  SpillStream finish() {
    SVDAG_ASSERT(!finished_);
    file_->queue.check();
    if (filled_ > 0) write(&own_);
    finished_ = true;
    return stream_;
  }

  uint64_t bytes() const { return stream_.bytes; }

 private:
  // Writes the full block and continues with a spare one, if there is one.
  void write_full() {
    if (SpillTransfer* const spare = file_->queue.take_spare(budget_)) {
      std::swap(spare->block, own_.block);
      write(spare);
    } else {
      write(&own_);
      file_->queue.wait(&own_);
    }
    file_->queue.check();
  }

  // If this fails, the transfer counts as done, so that no thread waits for it.
  void write(SpillTransfer* transfer) {
    try {
      stream_.blocks.push_back(file_->allocate());
    } catch (...) {
      file_->queue.cancel(transfer);
      throw;
    }
    transfer->position = stream_.blocks.back();
    transfer->writes = true;
    // Sealed by this thread, because the block is in its cache.
    const SpillLabel label = {stream_.number, stream_.blocks.size() - 1, uint32_t(filled_)};
    seal_block(transfer->block.bytes(), label);
    filled_ = 0;
    file_->queue.submit(transfer);
  }

  SpillFile::Impl* file_;
  const size_t payload_;
  MemoryBudget* budget_;
  SpillStream stream_;
  SpillTransfer own_;  // the block that is being filled
  size_t filled_ = 0;  // payload bytes in it
  bool finished_ = false;
};

SpillWriter::SpillWriter(SpillFile* file, uint64_t stream, MemoryBudget* budget)
    : impl_(std::make_unique<Impl>(file, stream, budget)) {}
SpillWriter::SpillWriter(SpillWriter&&) noexcept = default;
SpillWriter& SpillWriter::operator=(SpillWriter&&) noexcept = default;
SpillWriter::~SpillWriter() = default;

void SpillWriter::append(std::span<const std::byte> bytes) {
  impl_->append(bytes);
}

uint64_t SpillWriter::bytes() const {
  return impl_->bytes();
}

SpillStream SpillWriter::finish() {
  return impl_->finish();
}

class SpillReader::Impl {
 public:
  Impl(SpillFile* file, const SpillStream& stream, MemoryBudget* budget, size_t first)
      : file_(file->impl_.get()), budget_(budget), stream_(stream), index_(first) {
    const size_t payload = file->payload_bytes();
    if (stream_.blocks.size() != stream_.bytes / payload + (stream_.bytes % payload != 0))
      file_->fail_damaged();
    SVDAG_ASSERT(first <= stream_.blocks.size());
    request();
  }

  ~Impl() { file_->queue.wait(&ahead_); }

  std::span<std::byte> next() {
    if (index_ == stream_.blocks.size()) return {};
    file_->queue.wait(&ahead_);
    file_->queue.check();
    if (ahead_.failure) std::rethrow_exception(ahead_.failure);
    std::swap(current_, ahead_.block);
    const uint64_t index = index_++;
    request();
    // Checked by this thread, not by the I/O thread, so that the block is in its cache.
    return file_->open(current_, stream_, index);
  }

  [[noreturn]] void fail_damaged() const { file_->fail_damaged(); }

 private:
  // Requests the next block, if any.
  void request() {
    if (index_ == stream_.blocks.size()) return;
    if (!ahead_.block) ahead_.block = SpillBlock(budget_, file_->block_bytes);
    ahead_.position = stream_.blocks[index_];
    file_->queue.submit(&ahead_);
  }

  SpillFile::Impl* file_;
  MemoryBudget* budget_;
  const SpillStream stream_;
  size_t index_;        // of the requested block
  SpillBlock current_;  // returned by next()
  SpillTransfer ahead_;
};

SpillReader::SpillReader(SpillFile* file, const SpillStream& stream, MemoryBudget* budget,
                         size_t first)
    : impl_(std::make_unique<Impl>(file, stream, budget, first)) {}
SpillReader::SpillReader(SpillReader&&) noexcept = default;
SpillReader& SpillReader::operator=(SpillReader&&) noexcept = default;
SpillReader::~SpillReader() = default;

std::span<std::byte> SpillReader::next() {
  return impl_->next();
}

void SpillReader::fail_damaged() const {
  impl_->fail_damaged();
}

class SpillFetch::Impl {
 public:
  Impl(SpillFile* file, const SpillStream& stream, size_t index, SpillBlock block)
      : file_(file->impl_.get()), index_(index) {
    stream_.number = stream.number;
    stream_.bytes = stream.bytes;
    transfer_.block = std::move(block);
    transfer_.position = stream.blocks[index];
    file_->queue.submit(&transfer_);
  }
  ~Impl() { file_->queue.wait(&transfer_); }

  std::span<std::byte> wait() {
    file_->queue.wait(&transfer_);
    file_->queue.check();
    if (transfer_.failure) std::rethrow_exception(transfer_.failure);
    return file_->open(transfer_.block, stream_, index_);
  }
  SpillBlock take_block() {
    file_->queue.wait(&transfer_);
    return std::move(transfer_.block);
  }

 private:
  SpillFile::Impl* file_;
  SpillStream stream_;  // without the list of its blocks
  uint64_t index_;
  SpillTransfer transfer_;
};

SpillFetch::SpillFetch(SpillFile* file, const SpillStream& stream, size_t index, SpillBlock block)
    : impl_(std::make_unique<Impl>(file, stream, index, std::move(block))) {}
SpillFetch::SpillFetch(SpillFetch&&) noexcept = default;
SpillFetch::~SpillFetch() = default;

std::span<std::byte> SpillFetch::wait() {
  return impl_->wait();
}

SpillBlock SpillFetch::take_block() {
  return impl_->take_block();
}

}  // namespace svdag
