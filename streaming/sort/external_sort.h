// A parallel external sort: sorts more records than fit in memory.
//
// push() appends records to a buffer of half the memory. A full buffer is sorted into the other
// half (streaming/sort/parallel_sort.h) and spilled as one ascending stream per worker, each of its
// own range of keys, so that sorting, checksums and writing overlap. finish() merges the streams
// with all workers (streaming/sort/parallel_merge.h), in groups first if their blocks do not fit in
// memory. Each record is written once and read once, except by merges of groups. Input that fits in
// the buffer is not spilled. Rejected: distributing incoming records to ranges of keys (no merge,
// but another pass over each range that turns out too large; with sorted input all of them are).
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "streaming/sort/parallel_merge.h"
#include "streaming/sort/parallel_sort.h"

namespace svdag {

struct ExternalSortConfig {
  MemoryBudget* budget;  // `bytes` are reserved from it while the sort exists
  uint64_t bytes;        // at least kMinBytesPerWorker for each worker
  Executor* executor;
  std::function<File()> new_file;  // creates the spill file; called at most once

  static constexpr uint64_t kMinBytesPerWorker = uint64_t(1) << 19;
};

// Record: trivially copyable, with a size of 1, 2, 4, ..., 64 bytes. `word(record, i)` returns key
// word i < words as u32; records are ordered by their words, word 0 first. Records with equal keys
// come out in any order. Errors: kMemory if the budget has no room, kOutput if spilling fails, and
// what the Executor or the sink of finish() throws, such as Interrupted.
template <class Record, class Word>
class ExternalSort {
  static_assert(std::is_trivially_copyable_v<Record> && 64 % sizeof(Record) == 0);

 public:
  ExternalSort(const ExternalSortConfig& config, size_t words, Word word)
      : config_(config),
        reservation_(config.budget->reserve(config.bytes, "sort buffers")),
        inner_budget_(config.bytes),
        order_(words, word),
        block_bytes_(block_size(config)),
        capacity_((config.bytes - 2 * workers() * block_bytes_) / (2 * sizeof(Record))) {
    SVDAG_ASSERT(config.bytes >= workers() * ExternalSortConfig::kMinBytesPerWorker &&
                 capacity_ > 0);
    buffers_ = inner_budget_.reserve(2 * capacity_ * sizeof(Record), "sort buffers");
    in_.reserve(capacity_);  // the system commits the memory when it is first touched
  }

  // Adds a record; not after finish().
  void push(const Record& record) {
    if (in_.size() == capacity_) spill();
    in_.push_back(record);
  }

  // Ends the sort. Calls sink(span of records) with all records in ascending order: one call at a
  // time, each on the thread of any worker.
  template <class Sink>
  void finish(const Sink& sink) {
    if (streams_.empty()) return finish_in_memory(sink);
    if (!in_.empty()) spill();
    release_buffers();
    const size_t blocks = config_.bytes / block_bytes_ - 2;  // a writer takes two
    const size_t max_streams =
        std::max<size_t>(ParallelMerge<Record, Word>::max_streams(blocks, workers()), 2);
    while (streams_.size() > max_streams) merge_group(max_streams, blocks);
    merge(streams_, blocks, sink);
    for (const auto& stream : streams_) file_->free(stream.stream);
    streams_.clear();
  }

  // Peak memory in use, and total bytes written to and read from disk.
  uint64_t peak_bytes() const { return inner_budget_.peak(); }
  uint64_t written_bytes() const { return file_ ? file_->written_bytes() : 0; }
  uint64_t read_bytes() const { return file_ ? file_->read_bytes() : 0; }

 private:
  static constexpr uint64_t kBlocks = 512, kMinBlockBytes = 4096, kMaxBlockBytes = 1 << 20;
  using Stream = SortedStream<Record>;
  using Bucket = SortBucket<Record>;

  size_t workers() const { return config_.executor->workers(); }

  // Two blocks per worker take at most a quarter of the memory, so blocks are smaller with many
  // workers, and a merge can read at least three streams. A power of two, since direct I/O needs
  // multiples of 4096.
  static size_t block_size(const ExternalSortConfig& config) {
    const uint64_t limit = config.bytes / (8 * config.executor->workers());
    return std::bit_floor(
        std::clamp(std::min(config.bytes / kBlocks, limit), kMinBlockBytes, kMaxBlockBytes));
  }

  void release_buffers() {
    in_ = {};
    out_ = {};
    buffers_.release();
  }

  std::vector<Bucket> split() {
    out_.resize(in_.size());
    const size_t max_bucket = std::max<size_t>(in_.size() / (16 * workers()), size_t(1) << 14);
    ParallelSplit<Record, Word> split(order_, config_.executor);
    return split.split({in_.data(), out_.data(), in_.size(), 0}, max_bucket);
  }

  // Sorts a bucket and returns its records.
  std::span<const Record> sort(const Bucket& bucket) const {
    order_.sort(bucket.at, bucket.other, bucket.count, true, bucket.first);
    return {bucket.other, bucket.count};
  }

  // Runs task(part, buckets of the part) for `parts` parts with about the same number of records.
  template <class Task>
  void for_parts(std::span<const Bucket> buckets, size_t parts, const Task& task) {
    const std::vector<size_t> begin = even_parts(buckets, parts);
    config_.executor->for_each(parts, [&](size_t, size_t part) {
      task(part, buckets.subspan(begin[part], begin[part + 1] - begin[part]));
    });
  }

  void spill() {
    if (!file_) file_ = std::make_unique<SpillFile>(config_.new_file(), block_bytes_);
    const std::vector<Bucket> buckets = split();
    std::vector<Stream> streams(workers());
    const uint64_t number = new_streams(workers());
    for_parts(buckets, workers(), [&](size_t part, std::span<const Bucket> own) {
      check_interrupt();
      Writer writer(file_.get(), number + part, &inner_budget_);
      for (const Bucket& bucket : own) writer.append(sort(bucket));
      streams[part] = writer.finish();
    });
    for (Stream& stream : streams) {
      if (!stream.firsts.empty()) streams_.push_back(std::move(stream));
    }
    in_.clear();
  }

  template <class Sink>
  void finish_in_memory(const Sink& sink) {
    const std::vector<Bucket> buckets = split();
    Turns turns;
    for_parts(buckets, 16 * workers(), [&](size_t part, std::span<const Bucket> own) {
      turns.guard([&] {
        check_interrupt();
        std::vector<std::span<const Record>> sorted;
        for (const Bucket& bucket : own) sorted.push_back(sort(bucket));
        turns.run(part, [&] {
          for (const auto records : sorted) sink(records);
        });
      });
    });
    release_buffers();
  }

  // Merges the first `count` streams into one, which is appended to the list.
  void merge_group(size_t count, size_t blocks) {
    const std::span<const Stream> group(streams_.data(), count);
    Writer writer(file_.get(), new_streams(1), &inner_budget_);
    merge(group, blocks, [&](std::span<const Record> records) { writer.append(records); });
    Stream merged = writer.finish();
    for (const Stream& stream : group) file_->free(stream.stream);
    streams_.erase(streams_.begin(), streams_.begin() + ptrdiff_t(count));
    streams_.push_back(std::move(merged));
  }

  template <class Sink>
  void merge(std::span<const Stream> streams, size_t blocks, const Sink& sink) {
    ParallelMerge<Record, Word>(file_.get(), streams, blocks, &inner_budget_, order_,
                                config_.executor)
        .run(sink);
  }

  // Returns the first of `count` new stream numbers.
  uint64_t new_streams(size_t count) { return std::exchange(next_stream_, next_stream_ + count); }

  // Writes a stream and collects the first record of each of its blocks.
  class Writer {
   public:
    Writer(SpillFile* file, uint64_t number, MemoryBudget* budget)
        : per_block_(file->payload_bytes() / sizeof(Record)), writer_(file, number, budget) {}
    void append(std::span<const Record> records) {
      for (size_t i = (per_block_ - count_ % per_block_) % per_block_; i < records.size();
           i += per_block_)
        firsts_.push_back(records[i]);
      count_ += records.size();
      writer_.append(std::as_bytes(records));
    }
    Stream finish() { return {writer_.finish(), std::move(firsts_)}; }

   private:
    size_t per_block_, count_ = 0;
    SpillWriter writer_;
    std::vector<Record> firsts_;
  };

  const ExternalSortConfig config_;
  MemoryBudget::Reservation reservation_;  // of config_.bytes
  MemoryBudget inner_budget_;              // how these are used
  const RadixSort<Record, Word> order_;
  const size_t block_bytes_, capacity_;  // of a block; of a buffer in records
  HugeVector<Record> in_, out_;
  MemoryBudget::Reservation buffers_;  // of in_ and out_
  std::unique_ptr<SpillFile> file_;
  std::vector<Stream> streams_;
  uint64_t next_stream_ = 1;
};

}  // namespace svdag
