#include "streaming/spill/spill_file.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "streaming/error.h"
#include "streaming/spill/scratch_dir.h"

namespace svdag {

SpillFile::SpillFile(File file, size_t block_bytes, uint32_t first_free, ExitCode damaged)
    : block_bytes_(block_bytes),
      queue_(std::move(file), block_bytes),
      end_(first_free),
      damaged_(damaged) {
  SVDAG_ASSERT(block_bytes > 0 && block_bytes % SpillBlock::kAlignment == 0);
}

void SpillFile::free(const SpillStream& stream) noexcept {
  const std::lock_guard lock(mutex_);
  try {
    free_.insert(free_.end(), stream.blocks.rbegin(), stream.blocks.rend());
  } catch (const std::bad_alloc&) {
  }
}

uint64_t SpillFile::peak_bytes() const {
  const std::lock_guard lock(mutex_);
  return uint64_t(end_) * block_bytes_;
}

uint32_t SpillFile::allocate() {
  const std::lock_guard lock(mutex_);
  if (free_.empty()) {
    if (end_ == UINT32_MAX)
      throw Error(ExitCode::kOutput, "a scratch file cannot hold more than 2^32 - 1 blocks",
                  queue_.path());
    return end_++;
  }
  const uint32_t position = free_.back();
  free_.pop_back();
  return position;
}

void SpillFile::wait(SpillTransfer* read) {
  queue_.wait(read);
  queue_.check();
  if (read->failure) std::rethrow_exception(read->failure);
}

std::span<std::byte> SpillFile::open(const SpillBlock& block, const SpillStream& stream,
                                     uint64_t index) const {
  const uint64_t payload = payload_bytes();
  const uint32_t length = uint32_t(std::min<uint64_t>(payload, stream.bytes - index * payload));
  if (!open_block(block.bytes(), {stream.number, index, length})) fail_damaged();
  return block.bytes().subspan(kHeader, length);
}

void SpillFile::fail_damaged() const {
  if (damaged_ == ExitCode::kBadInput)
    throw Error(damaged_, "is damaged: create it again", queue_.path());
  throw InvalidScratch(damaged_, "scratch file is damaged", queue_.path());
}

SpillWriter::SpillWriter(SpillFile* file, uint64_t stream, MemoryBudget* budget)
    : file_(file), budget_(budget), own_(std::make_unique<SpillTransfer>()) {
  stream_.number = stream;
  file_->queue_.enter_writer();
}

SpillWriter::~SpillWriter() {
  if (!own_) return;
  file_->queue_.wait(own_.get());
  file_->queue_.leave_writer();
  if (!finished_) file_->free(stream_);
}

void SpillWriter::append(std::span<const std::byte> bytes) {
  SVDAG_ASSERT(!finished_);
  file_->queue_.check();
  const size_t payload = file_->payload_bytes();
  while (!bytes.empty()) {
    if (!own_->block) own_->block = SpillBlock(budget_, file_->block_bytes_);
    const size_t n = std::min(bytes.size(), payload - filled_);
    std::memcpy(own_->block.bytes().data() + SpillFile::kHeader + filled_, bytes.data(), n);
    bytes = bytes.subspan(n);
    filled_ += n;
    stream_.bytes += n;
    if (filled_ == payload) write_full();
  }
}

SpillStream SpillWriter::finish() {
  SVDAG_ASSERT(!finished_);
  file_->queue_.check();
  if (filled_ > 0) write(own_.get());
  finished_ = true;
  return stream_;
}

// Writes the full block and continues with a spare one, if there is one.
void SpillWriter::write_full() {
  if (SpillTransfer* const spare = file_->queue_.take_spare(budget_)) {
    std::swap(spare->block, own_->block);
    write(spare);
  } else {
    write(own_.get());
    file_->queue_.wait(own_.get());
  }
  file_->queue_.check();
}

// If this fails, the transfer counts as done, so that no thread waits for it.
void SpillWriter::write(SpillTransfer* transfer) {
  try {
    stream_.blocks.push_back(file_->allocate());
  } catch (...) {
    file_->queue_.cancel(transfer);
    throw;
  }
  transfer->position = stream_.blocks.back();
  transfer->writes = true;
  // Sealed by this thread, because the block is in its cache.
  const SpillLabel label = {stream_.number, stream_.blocks.size() - 1, uint32_t(filled_)};
  seal_block(transfer->block.bytes(), label);
  filled_ = 0;
  file_->queue_.submit(transfer);
}

SpillReader::SpillReader(SpillFile* file, const SpillStream& stream, MemoryBudget* budget,
                         size_t first)
    : file_(file),
      budget_(budget),
      stream_(stream),
      index_(first),
      ahead_(std::make_unique<SpillTransfer>()) {
  const size_t payload = file->payload_bytes();
  if (stream_.blocks.size() != stream_.bytes / payload + (stream_.bytes % payload != 0))
    fail_damaged();
  SVDAG_ASSERT(first <= stream_.blocks.size());
  request();
}

SpillReader::~SpillReader() {
  if (ahead_) file_->queue_.wait(ahead_.get());
}

std::span<std::byte> SpillReader::next() {
  if (index_ == stream_.blocks.size()) return {};
  file_->wait(ahead_.get());
  std::swap(current_, ahead_->block);
  const uint64_t index = index_++;
  request();  // before the check, so that disk and processor overlap
  return file_->open(current_, stream_, index);
}

// Requests the next block, if any.
void SpillReader::request() {
  if (index_ == stream_.blocks.size()) return;
  if (!ahead_->block) ahead_->block = SpillBlock(budget_, file_->block_bytes_);
  ahead_->position = stream_.blocks[index_];
  file_->queue_.submit(ahead_.get());
}

SpillFetch::SpillFetch(SpillFile* file, const SpillStream& stream, size_t index, SpillBlock block)
    : file_(file), index_(index) {
  stream_.number = stream.number;
  stream_.bytes = stream.bytes;
  transfer_.block = std::move(block);
  transfer_.position = stream.blocks[index];
  file_->queue_.submit(&transfer_);
}

SpillFetch::~SpillFetch() {
  file_->queue_.wait(&transfer_);
}

SpillBlock SpillFetch::take_block() {
  file_->queue_.wait(&transfer_);
  return std::move(transfer_.block);
}

}  // namespace svdag
