// A parallel k-way merge of sorted streams of a spill file.
//
// The index of a stream is the list of the first records of its blocks. All blocks of all streams,
// ordered by their first records (the *schedule*), are in the order in which a merge needs them
// (the "prediction sequence" of Hutchinson, Sanders and Vitter). So they are read in this order,
// each once, ahead of their use. A *piece* is the range of records between the first records of two
// blocks of the schedule that are `step` blocks apart: `step` new blocks and the rest of at most
// one block per stream. Pieces are cut in order, merged by any free worker, and delivered in order.
// Equal records are ordered by stream and block, so cuts are exact for any number of them.
// Rejected: one range of keys per worker (the second range could only be delivered after the
// first), a reader per stream (twice the memory, and reads out of order).
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "streaming/memory/huge_vector.h"
#include "streaming/process/executor.h"
#include "streaming/process/interrupt.h"
#include "streaming/sort/radix_sort.h"
#include "streaming/sort/tournament.h"
#include "streaming/sort/turns.h"
#include "streaming/spill/spill_file.h"

namespace svdag {

// A stream of ascending records in a spill file, and its index.
template <class Record>
struct SortedStream {
  SpillStream stream;
  std::vector<Record> firsts;  // the first record of each block
};

// The records that one stream contributes to a piece, from one or more of its blocks.
template <class Record>
class PieceSource {
 public:
  void add(std::span<const Record> records) {
    if (!records.empty()) spans_.push_back(records);
  }
  void start() {
    if (!spans_.empty()) at_ = spans_.front().data(), end_ = at_ + spans_.front().size();
  }
  bool ended() const { return at_ == end_; }
  const Record& head() const { return *at_; }
  void advance() {
    if (++at_ == end_ && ++span_ < spans_.size())
      at_ = spans_[span_].data(), end_ = at_ + spans_[span_].size();
  }
  std::span<const std::span<const Record>> spans() const { return spans_; }

 private:
  std::vector<std::span<const Record>> spans_;
  size_t span_ = 0;
  const Record* at_ = nullptr;
  const Record* end_ = nullptr;
};

template <class Record, class Word>
class ParallelMerge {
 public:
  // Maximum number of streams that can be merged with memory for `blocks` blocks: those of the
  // pieces being merged, of the read-ahead, of the rests, and of the output.
  static size_t max_streams(size_t blocks, size_t workers) { return blocks / (2 * workers + 2); }
  // Number of new blocks per piece with that memory, at least 1.
  static size_t step(size_t blocks, size_t streams, size_t workers) {
    const size_t held = std::min((workers + 1) * streams, blocks);  // for streams, with any step
    return std::max<size_t>((blocks - held) / (2 * workers + 1), 1);
  }

  ParallelMerge(SpillFile* file, std::span<const SortedStream<Record>> streams, size_t blocks,
                MemoryBudget* budget, const RadixSort<Record, Word>& order, Executor* executor)
      : file_(file),
        streams_(streams),
        step_(step(blocks, streams.size(), executor->workers())),
        budget_(budget),
        order_(order),
        executor_(executor) {
    for (uint32_t s = 0; s < streams.size(); ++s) {
      for (uint32_t b = 0; b < streams[s].firsts.size(); ++b) schedule_.push_back({s, b});
    }
    std::sort(schedule_.begin(), schedule_.end(), [&](const BlockId& a, const BlockId& b) {
      if (order_.less(first(a), first(b))) return true;
      if (order_.less(first(b), first(a))) return false;
      return a.stream != b.stream ? a.stream < b.stream : a.block < b.block;
    });
  }

  // Calls sink(span of records) with all records in ascending order: one call at a time, each on
  // the thread of any worker.
  template <class Sink>
  void run(const Sink& sink) {
    request(step_);
    std::vector<HugeVector<Record>> outputs(executor_->workers());
    std::vector<MemoryBudget::Reservation> reserved;
    for (HugeVector<Record>& output : outputs) {
      const size_t max_records = (step_ + streams_.size()) * file_->block_bytes() / sizeof(Record);
      reserved.push_back(budget_->reserve(max_records * sizeof(Record), "merge buffers"));
      output.reserve(max_records);
    }
    const size_t pieces = (schedule_.size() + step_ - 1) / step_;
    executor_->for_each(pieces, [&](size_t worker, size_t) {
      turns_.guard([&] {
        check_interrupt();
        std::optional<MergePiece> piece = cut();
        if (piece) merge_piece(&*piece, &outputs[worker], sink);
      });
    });
  }

 private:
  struct BlockId {
    uint32_t stream, block;  // indices of the stream, and of the block in its stream
  };
  // A block in memory, and a range of its records.
  struct LoadedBlock {
    BlockId id;
    std::shared_ptr<SpillFetch> fetch;
    std::span<const Record> records;
  };
  struct MergePiece {
    size_t number;
    std::vector<LoadedBlock> blocks;  // the records of the piece; sorted by id
  };

  const Record& first(const BlockId& id) const { return streams_[id.stream].firsts[id.block]; }

  // Requests the next `count` blocks of the schedule.
  void request(size_t count) {
    for (; count > 0 && requested_ < schedule_.size(); --count) {
      const BlockId id = schedule_[requested_++];
      pending_.push_back(fetch(id));
    }
  }
  // Reserves a slot of idle_ for the block, because the deleter that returns it must not throw.
  SpillBlock new_block() {
    const std::lock_guard lock(idle_mutex_);
    idle_.reserve(++block_count_);
    return {budget_, file_->block_bytes()};
  }
  std::shared_ptr<SpillFetch> fetch(const BlockId& id) {
    SpillBlock block;
    {
      const std::lock_guard lock(idle_mutex_);
      if (!idle_.empty()) block = std::move(idle_.back()), idle_.pop_back();
    }
    if (!block) block = new_block();
    auto* const fetch =
        new SpillFetch(file_, streams_[id.stream].stream, id.block, std::move(block));
    return {fetch, [this](SpillFetch* done) {
              SpillBlock memory = done->take_block();
              delete done;
              const std::lock_guard lock(idle_mutex_);
              idle_.push_back(std::move(memory));
            }};
  }

  // Returns the next piece. Returns none if another worker has failed here: the state is then
  // invalid, and that worker reports the error.
  std::optional<MergePiece> cut() {
    const std::lock_guard lock(cut_mutex_);
    if (cut_failed_) return std::nullopt;
    cut_failed_ = true;  // if cut_next() throws
    MergePiece piece = cut_next();
    cut_failed_ = false;
    return piece;
  }

  // Returns the records of all loaded blocks that go before the first record of the next block.
  MergePiece cut_next() {
    MergePiece piece{cut_ / step_, std::move(rests_)};
    rests_.clear();
    const size_t until = std::min(cut_ + step_, schedule_.size());
    for (; cut_ < until; ++cut_) {
      std::shared_ptr<SpillFetch> fetch = std::move(pending_.front());
      pending_.pop_front();
      const std::span<std::byte> bytes = fetch->wait();
      const auto* const records = reinterpret_cast<const Record*>(bytes.data());
      piece.blocks.push_back(
          {schedule_[cut_], std::move(fetch), {records, bytes.size() / sizeof(Record)}});
    }
    request(step_);
    if (until < schedule_.size()) {
      for (LoadedBlock& block : piece.blocks) {
        const size_t n = count_before(block, schedule_[until]);
        if (n < block.records.size()) {
          rests_.push_back(block);
          rests_.back().records = block.records.subspan(n);
          block.records = block.records.first(n);
        }
      }
    }
    std::sort(
        piece.blocks.begin(), piece.blocks.end(), [](const LoadedBlock& a, const LoadedBlock& b) {
          return a.id.stream != b.id.stream ? a.id.stream < b.id.stream : a.id.block < b.id.block;
        });
    return piece;
  }

  // Number of records of `block` that go before block `bound`.
  size_t count_before(const LoadedBlock& block, const BlockId& bound) const {
    const std::span<const Record> records = block.records;
    if (block.id.stream == bound.stream) return records.size();
    const Record& limit = first(bound);
    const auto less = [&](const Record& a, const Record& b) { return order_.less(a, b); };
    const auto at = block.id.stream < bound.stream
                        ? std::upper_bound(records.begin(), records.end(), limit, less)
                        : std::lower_bound(records.begin(), records.end(), limit, less);
    return size_t(at - records.begin());
  }

  template <class Sink>
  void merge_piece(MergePiece* piece, HugeVector<Record>* output, const Sink& sink) {
    std::vector<PieceSource<Record>> sources;
    for (size_t b = 0; b < piece->blocks.size(); ++b) {
      if (piece->blocks[b].records.empty()) continue;
      const bool same =
          !sources.empty() && last_stream_before(*piece, b) == piece->blocks[b].id.stream;
      if (!same) sources.emplace_back();
      sources.back().add(piece->blocks[b].records);
    }
    if (sources.size() == 1) {
      turns_.run(piece->number, [&] {
        for (const auto records : sources[0].spans()) sink(records);
        piece->blocks.clear();  // frees memory for the read-ahead, which the next turn may need
      });
      return;
    }
    merge(sources, output);
    piece->blocks.clear();  // frees memory for the read-ahead
    turns_.run(piece->number, [&] {
      if (!output->empty()) sink(std::span<const Record>(*output));
    });
  }

  // The stream of the last non-empty block before block b; UINT32_MAX if there is none.
  static uint32_t last_stream_before(const MergePiece& piece, size_t b) {
    while (b-- > 0) {
      if (!piece.blocks[b].records.empty()) return piece.blocks[b].id.stream;
    }
    return UINT32_MAX;
  }

  void merge(std::span<PieceSource<Record>> sources, HugeVector<Record>* out) {
    size_t total = 0;
    for (auto& source : sources) {
      source.start();
      for (const auto records : source.spans()) total += records.size();
    }
    const size_t word = first_differing(sources);
    const auto prefix = [&](size_t s) {
      return sources[s].ended() ? UINT64_MAX : order_.prefix(sources[s].head(), word);
    };
    const auto less = [&](size_t a, size_t b) {
      if (sources[a].ended() || sources[b].ended()) return !sources[a].ended();
      return order_.less(sources[a].head(), sources[b].head(), word + 2);
    };
    Tournament tournament(sources.size(), prefix, less);
    out->resize(total);
    for (Record& record : *out) {
      PieceSource<Record>& source = sources[tournament.winner()];
      record = source.head();
      source.advance();
      tournament.replay();
    }
  }

  // The first word in which the records of a piece may differ.
  size_t first_differing(std::span<const PieceSource<Record>> sources) const {
    if (sources.empty()) return 0;
    const Record& like = sources[0].head();
    for (size_t w = 0; w < order_.words(); ++w) {
      for (const auto& source : sources) {
        const Record& last = source.spans().back().back();
        if (order_.differing({&source.head(), 1}, like, w) != 0) return w;
        if (order_.differing({&last, 1}, like, w) != 0) return w;
      }
    }
    return order_.words() - 1;
  }

  SpillFile* file_;
  std::span<const SortedStream<Record>> streams_;
  const size_t step_;
  MemoryBudget* budget_;
  const RadixSort<Record, Word>& order_;
  Executor* executor_;
  std::vector<BlockId> schedule_;

  std::mutex idle_mutex_;
  std::vector<SpillBlock> idle_;  // memory to read into; outlives the fetches that return theirs
  size_t block_count_ = 0;        // of all blocks, idle or not
  Turns turns_;
  std::mutex cut_mutex_;  // guards all that follows
  bool cut_failed_ = false;
  size_t requested_ = 0, cut_ = 0;  // number of blocks of the schedule that were requested, cut
  std::deque<std::shared_ptr<SpillFetch>> pending_;
  std::vector<LoadedBlock> rests_;  // records that belong to later pieces
};

}  // namespace svdag
