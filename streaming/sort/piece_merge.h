// The k-way merge of sorted streams of a spill file, by several workers at once.
//
// The index of a stream holds the first record of each of its blocks. All blocks of all streams,
// ordered by their first records (the *schedule*), are in the order in which a merge needs them
// (the "prediction sequence" of Hutchinson, Sanders and Vitter). So they are read in this order,
// each once, ahead of their use. A *piece* holds the records between the first records of two
// blocks of the schedule that are `step` blocks apart: `step` new blocks and the rest of at most
// one block per stream. Pieces are cut in order, merged by any free worker, and delivered in order.
// Equal records are ordered by stream and block, so a cut is exact however many there are.
// Rejected: one range of keys per worker (the second range could only be delivered when the first
// is done), a reader per stream (twice the memory, and reads out of order).
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

// Ascending records in a spill file, and the first one of each block.
template <class Record>
struct SortedStream {
  SpillStream stream;
  std::vector<Record> firsts;
};

// Records of a piece that one stream has, in one or more of its blocks.
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
class PieceMerge {
 public:
  // Streams that can be merged, and blocks per piece, with memory for `blocks` blocks: those of the
  // pieces being merged, what is read ahead, what is left over, and as much for the output.
  static size_t most_streams(size_t blocks, size_t workers) { return blocks / (2 * workers + 2); }
  static size_t step(size_t blocks, size_t streams, size_t workers) {
    const size_t held = std::min((workers + 1) * streams, blocks);  // of streams, whatever the step
    return std::max<size_t>((blocks - held) / (2 * workers + 1), 1);
  }

  PieceMerge(SpillFile* file, std::span<const SortedStream<Record>> streams, size_t blocks,
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
    std::sort(schedule_.begin(), schedule_.end(), [&](const Place& a, const Place& b) {
      if (order_.less(first(a), first(b))) return true;
      if (order_.less(first(b), first(a))) return false;
      return a.stream != b.stream ? a.stream < b.stream : a.block < b.block;
    });
  }

  // take(records) gets all of them in ascending order: one call at a time, by any worker.
  template <class Take>
  void run(const Take& take) {
    request(step_);
    std::vector<HugeVector<Record>> rooms(executor_->workers());
    std::vector<MemoryBudget::Reservation> reserved;
    for (HugeVector<Record>& room : rooms) {
      const size_t most = (step_ + streams_.size()) * file_->block_bytes() / sizeof(Record);
      reserved.push_back(budget_->reserve(most * sizeof(Record), "merging"));
      room.reserve(most);
    }
    const size_t pieces = (schedule_.size() + step_ - 1) / step_;
    executor_->for_each(pieces, [&](size_t worker, size_t) {
      try {
        check_interrupt();
        std::optional<Piece> piece = cut();
        if (piece) merge_piece(&*piece, &rooms[worker], take);
      } catch (...) {
        turns_.fail();
        throw;
      }
    });
  }

 private:
  struct Place {
    uint32_t stream, block;
  };
  // A block in memory, and those of its records that no piece has got yet.
  struct Block {
    Place place;
    std::shared_ptr<SpillFetch> fetch;
    std::span<const Record> left;
  };
  struct Piece {
    size_t number;
    std::vector<Block> blocks;  // [left]: what belongs to the piece; by stream and place
  };

  const Record& first(const Place& place) const {
    return streams_[place.stream].firsts[place.block];
  }

  // Requests the next `count` blocks of the schedule.
  void request(size_t count) {
    for (; count > 0 && asked_ < schedule_.size(); --count) {
      const Place place = schedule_[asked_++];
      coming_.push_back(fetch(place));
    }
  }
  // There is room for it among the idle ones, for it may come back where nothing may be thrown.
  SpillBlock new_block() {
    const std::lock_guard lock(idle_mutex_);
    idle_.reserve(++blocks_);
    return {budget_, file_->block_bytes()};
  }
  std::shared_ptr<SpillFetch> fetch(const Place& place) {
    SpillBlock block;
    {
      const std::lock_guard lock(idle_mutex_);
      if (!idle_.empty()) block = std::move(idle_.back()), idle_.pop_back();
    }
    if (!block) block = new_block();
    auto* const fetch =
        new SpillFetch(file_, streams_[place.stream].stream, place.block, std::move(block));
    return {fetch, [this](SpillFetch* done) {
              SpillBlock memory = done->take_block();
              delete done;
              const std::lock_guard lock(idle_mutex_);
              idle_.push_back(std::move(memory));
            }};
  }

  // The next piece; none after another worker has failed here: the blocks are in an invalid state,
  // and its error is the one to report.
  std::optional<Piece> cut() {
    const std::lock_guard lock(cut_mutex_);
    if (cut_failed_) return std::nullopt;
    cut_failed_ = true;  // until it is done
    Piece piece = cut_next();
    cut_failed_ = false;
    return piece;
  }

  // Of all blocks at hand what goes before the first record of the next one.
  Piece cut_next() {
    Piece piece{cut_ / step_, std::move(open_)};
    open_.clear();
    const size_t until = std::min(cut_ + step_, schedule_.size());
    for (; cut_ < until; ++cut_) {
      std::shared_ptr<SpillFetch> fetch = std::move(coming_.front());
      coming_.pop_front();
      const std::span<std::byte> bytes = fetch->wait();
      const auto* const records = reinterpret_cast<const Record*>(bytes.data());
      piece.blocks.push_back(
          {schedule_[cut_], std::move(fetch), {records, bytes.size() / sizeof(Record)}});
    }
    request(step_);
    if (until < schedule_.size()) {
      for (Block& block : piece.blocks) {
        const size_t n = before(block, schedule_[until]);
        if (n < block.left.size()) {
          open_.push_back(block);
          open_.back().left = block.left.subspan(n);
          block.left = block.left.first(n);
        }
      }
    }
    std::sort(piece.blocks.begin(), piece.blocks.end(), [](const Block& a, const Block& b) {
      return a.place.stream != b.place.stream ? a.place.stream < b.place.stream
                                              : a.place.block < b.place.block;
    });
    return piece;
  }

  // How many records of `block` go before the block at `bound`.
  size_t before(const Block& block, const Place& bound) const {
    if (block.place.stream == bound.stream) return block.left.size();
    const Record& limit = first(bound);
    const auto less = [&](const Record& a, const Record& b) { return order_.less(a, b); };
    const auto at = block.place.stream < bound.stream
                        ? std::upper_bound(block.left.begin(), block.left.end(), limit, less)
                        : std::lower_bound(block.left.begin(), block.left.end(), limit, less);
    return size_t(at - block.left.begin());
  }

  template <class Take>
  void merge_piece(Piece* piece, HugeVector<Record>* room, const Take& take) {
    std::vector<PieceSource<Record>> sources;
    for (size_t b = 0; b < piece->blocks.size(); ++b) {
      if (piece->blocks[b].left.empty()) continue;
      const bool same =
          !sources.empty() && last_stream_of(*piece, b) == piece->blocks[b].place.stream;
      if (!same) sources.emplace_back();
      sources.back().add(piece->blocks[b].left);
    }
    if (sources.size() == 1) {
      turns_.take(piece->number, [&] {
        for (const auto records : sources[0].spans()) take(records);
        piece->blocks.clear();  // memory for what is read ahead; the next turn may need it
      });
      return;
    }
    merge(sources, room);
    piece->blocks.clear();  // memory for what is read ahead
    turns_.take(piece->number, [&] {
      if (!room->empty()) take(std::span<const Record>(*room));
    });
  }

  // The stream of the last non-empty block before block b.
  static uint32_t last_stream_of(const Piece& piece, size_t b) {
    while (b-- > 0) {
      if (!piece.blocks[b].left.empty()) return piece.blocks[b].place.stream;
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
  std::vector<Place> schedule_;

  std::mutex idle_mutex_;
  std::vector<SpillBlock> idle_;  // memory to read into; before all that gives it back
  size_t blocks_ = 0;             // that there are, idle or not
  Turns turns_;
  std::mutex cut_mutex_;  // all that follows
  bool cut_failed_ = false;
  size_t asked_ = 0, cut_ = 0;  // places of the schedule
  std::deque<std::shared_ptr<SpillFetch>> coming_;
  std::vector<Block> open_;  // with records that no piece has got yet
};

}  // namespace svdag
