// Sorts more records than fit in memory, with all workers.
//
// Records are pushed into a buffer of half the memory. When it is full it is sorted into the other
// half (streaming/sort/parallel_sort.h) and spilled as a run: one ascending stream per worker, each
// of its own part of the keys, so that sorting, checksums and writing overlap. In the end the runs
// are merged by all workers (streaming/sort/piece_merge.h); so many runs that their blocks do not
// fit are merged in groups first. Each record is written once and read once, but for the groups.
// What fits in the buffer never sees the disk. Rejected: dealing records into ranges of keys while
// they come (no merge, but one pass per range that turns out too large; sorted input makes all of
// them so).
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "streaming/sort/parallel_sort.h"
#include "streaming/sort/piece_merge.h"

namespace svdag {

struct ExternalSortRoom {
  MemoryBudget* budget;  // `bytes` are taken from it as long as the sort lives
  uint64_t bytes;        // at least kLeast per worker
  Executor* executor;
  std::function<File()> new_file;  // called if something must be spilled

  static constexpr uint64_t kLeast = uint64_t(1) << 19;
};

// Record: trivially copyable, its size a power of two up to 64. `word(record, i)` gives key word
// i < words; records are ordered by these, the most significant first. Equal ones come out in any
// order.
template <class Record, class Word>
class ExternalSort {
  static_assert(std::is_trivially_copyable_v<Record> && 64 % sizeof(Record) == 0);

 public:
  ExternalSort(const ExternalSortRoom& room, size_t words, Word word)
      : room_(room),
        taken_(room.budget->reserve(room.bytes, "sort buffers")),
        own_(room.bytes),
        order_(words, word),
        block_bytes_(size_of_blocks(room)),
        capacity_((room.bytes - 2 * workers() * block_bytes_) / (2 * sizeof(Record))) {
    SVDAG_ASSERT(room.bytes >= workers() * ExternalSortRoom::kLeast && capacity_ > 0);
    buffers_ = own_.reserve(2 * capacity_ * sizeof(Record), "sorting");
    in_.reserve(capacity_);  // memory is taken when it is first touched
  }

  void push(const Record& record) {
    if (in_.size() == capacity_) spill();
    in_.push_back(record);
  }

  // Ends the sort. take(records), a span, gets all records in ascending order: one call at a time,
  // each by any of the workers.
  template <class Take>
  void finish(const Take& take) {
    if (streams_.empty()) return finish_in_memory(take);
    if (!in_.empty()) spill();
    give_up_buffers();
    const size_t blocks = room_.bytes / block_bytes_ - 2;  // a writer has two
    const size_t most =
        std::max<size_t>(PieceMerge<Record, Word>::most_streams(blocks, workers()), 2);
    while (streams_.size() > most) merge_group(most, blocks);
    merge(streams_, blocks, take);
    for (const auto& stream : streams_) file_->free(stream.stream);
    streams_.clear();
  }

  // Of the memory, the most that was in use at once; bytes that went to disk and came back.
  uint64_t peak_bytes() const { return own_.peak(); }
  uint64_t written_bytes() const { return file_ ? file_->written_bytes() : 0; }
  uint64_t read_bytes() const { return file_ ? file_->read_bytes() : 0; }

 private:
  static constexpr uint64_t kBlocks = 512, kSmallestBlock = 4096, kLargestBlock = 1 << 20;
  using Stream = SortedStream<Record>;
  using Bucket = SortBucket<Record>;

  size_t workers() const { return room_.executor->workers(); }

  // With many workers blocks are smaller: two per worker take at most a quarter of the memory, and
  // a merge can read at least three streams. A power of two, since direct I/O needs multiples of
  // 4096.
  static size_t size_of_blocks(const ExternalSortRoom& room) {
    const uint64_t most = room.bytes / (8 * room.executor->workers());
    return std::bit_floor(
        std::clamp(std::min(room.bytes / kBlocks, most), kSmallestBlock, kLargestBlock));
  }

  void give_up_buffers() {
    in_ = {};
    out_ = {};
    buffers_.release();
  }

  std::vector<Bucket> split() {
    out_.resize(in_.size());
    const size_t most = std::max<size_t>(in_.size() / (16 * workers()), size_t(1) << 14);
    ParallelSplit<Record, Word> split(order_, room_.executor);
    return split.split({in_.data(), out_.data(), in_.size(), 0}, most);
  }

  // Sorts a bucket; the records are then where this points to.
  std::span<const Record> sort(const Bucket& bucket) const {
    order_.sort(bucket.at, bucket.other, bucket.count, true, bucket.first);
    return {bucket.other, bucket.count};
  }

  // Runs task(part, its buckets) for parts of about as many records each.
  template <class Task>
  void for_parts(std::span<const Bucket> buckets, size_t parts, const Task& task) {
    const std::vector<size_t> begin = even_parts(buckets, parts);
    room_.executor->for_each(parts, [&](size_t, size_t part) {
      task(part, buckets.subspan(begin[part], begin[part + 1] - begin[part]));
    });
  }

  void spill() {
    if (!file_) file_ = std::make_unique<SpillFile>(room_.new_file(), block_bytes_);
    const std::vector<Bucket> buckets = split();
    std::vector<Stream> streams(workers());
    const uint64_t number = new_streams(workers());
    for_parts(buckets, workers(), [&](size_t part, std::span<const Bucket> own) {
      check_interrupt();
      Writer writer(file_.get(), number + part, &own_);
      for (const Bucket& bucket : own) writer.append(sort(bucket));
      streams[part] = writer.finish();
    });
    for (Stream& stream : streams) {
      if (!stream.firsts.empty()) streams_.push_back(std::move(stream));
    }
    in_.clear();
  }

  template <class Take>
  void finish_in_memory(const Take& take) {
    const std::vector<Bucket> buckets = split();
    Turns turns;
    for_parts(buckets, 16 * workers(), [&](size_t part, std::span<const Bucket> own) {
      try {  // whatever ends a part must end those that wait for their turn behind it
        check_interrupt();
        std::vector<std::span<const Record>> sorted;
        for (const Bucket& bucket : own) sorted.push_back(sort(bucket));
        turns.take(part, [&] {
          for (const auto records : sorted) take(records);
        });
      } catch (...) {
        turns.fail();
        throw;
      }
    });
    give_up_buffers();
  }

  // Merges the first `most` streams into one that goes to the end of the list.
  void merge_group(size_t most, size_t blocks) {
    const std::span<const Stream> group(streams_.data(), most);
    Writer writer(file_.get(), new_streams(1), &own_);
    merge(group, blocks, [&](std::span<const Record> records) { writer.append(records); });
    Stream merged = writer.finish();
    for (const Stream& stream : group) file_->free(stream.stream);
    streams_.erase(streams_.begin(), streams_.begin() + ptrdiff_t(most));
    streams_.push_back(std::move(merged));
  }

  template <class Take>
  void merge(std::span<const Stream> streams, size_t blocks, const Take& take) {
    PieceMerge<Record, Word>(file_.get(), streams, blocks, &own_, order_, room_.executor).run(take);
  }

  uint64_t new_streams(size_t count) { return std::exchange(next_stream_, next_stream_ + count); }

  // A stream and its index.
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

  const ExternalSortRoom room_;
  MemoryBudget::Reservation taken_;
  MemoryBudget own_;  // how `bytes` are used
  const RadixSort<Record, Word> order_;
  const size_t block_bytes_, capacity_;
  HugeVector<Record> in_, out_;
  MemoryBudget::Reservation buffers_;  // of these
  std::unique_ptr<SpillFile> file_;
  std::vector<Stream> streams_;
  uint64_t next_stream_ = 1;
};

}  // namespace svdag
