// The k-way merge of one level: merges ascending sources with unique keys into one, and returns for
// every source the map from its ranks to indices in the output.
//
// Rejected: one merge for this and for the records of imports (streaming/sort/parallel_merge.h):
// numbering keys in pieces needs an index in every run and a count of the unique keys before
// each piece, a second pass.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "builder/merge/level_source.h"
#include "builder/merge/rank_maps.h"
#include "io/dag/write/level_piece.h"
#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/process/executor.h"
#include "streaming/process/interrupt.h"
#include "streaming/sort/tournament.h"
#include "streaming/sort/turns.h"

namespace svdag {

// The keys of one source: in memory, or in blocks that are read.
template <class Key>
struct LevelInput {
  std::span<const Key> keys;  // in memory, if `blocks` is null
  std::function<std::unique_ptr<BlockSource>()> blocks;
  uint64_t bytes = 0;            // size of the blocks
  const RankMap* map = nullptr;  // rewrites the children in nodes read from `blocks`

  uint64_t count() const { return blocks ? bytes / sizeof(Key) : keys.size(); }
  LevelSource<Key> open() const {
    return blocks ? LevelSource<Key>(blocks(), count(), map) : LevelSource<Key>(keys);
  }
};

// An input from a stream in `file`; both must outlive the input.
template <class Key>
LevelInput<Key> spilled_input(SpillFile* file, const SpillStream& stream, MemoryBudget* budget,
                              const RankMap* map = nullptr) {
  const SpillStream* from = &stream;
  const auto open = [=] { return std::make_unique<SpillReader>(file, *from, budget); };
  return {{}, open, stream.bytes, map};
}

// Called with the numbers of keys of the inputs and of the output that were merged.
using MergeProgress = std::function<void(uint64_t, uint64_t)>;

// The k-way merge of one level, in pieces. A piece takes from every source the keys up to a bound,
// so equal keys are in one piece. Any worker cuts the next piece off, merges and encodes it while
// others work on further ones, waits for its turn only to get its place in the output, and then
// stores it and sets the maps.
// Rejected: one range of keys per worker (the second could only be placed after the first); all
// workers on one part of the sources at a time (they wait for each other every two milliseconds).
//
// `Output`: has encode(), append() and store() as a DagWriter does (io/dag/write/dag_writer.h).
template <class Key, class Output>
class LevelMerge {
 public:
  LevelMerge(std::vector<LevelSource<Key>> sources, Output* output, RankMaps* maps,
             MemoryBudget* budget, Executor* executor)
      : sources_(std::move(sources)),
        output_(output),
        maps_(maps),
        executor_(executor),
        share_(keys_per_piece(*budget, executor->workers()) / std::max<size_t>(sources_.size(), 1) +
               1),
        reservation_(budget->reserve(
            executor->workers() * 2 * share_ * sources_.size() * kBytesPerKey, "merge buffers")) {}

  void run(const MergeProgress& progress) {
    executor_->for_each(executor_->workers(), [&](size_t, size_t) {
      turns_.guard([&] {
        for (Piece piece; cut(&piece);) {
          merge(&piece);
          if (!place(&piece)) return;
          progress(piece.taken, piece.encoded.indices.size());
        }
      });
    });
  }

 private:
  static constexpr uint64_t kMinKeysPerPiece = 1 << 6, kMaxKeysPerPiece = 1 << 14;
  static constexpr size_t kKeysEncodedAtOnce = 256;
  // As it is, encoded, in a block, and two numbers.
  static constexpr size_t kBytesPerKey = 3 * (sizeof(Key) + sizeof(uint32_t));

  struct Piece {
    size_t number = 0;
    size_t taken = 0;                              // number of keys
    std::vector<uint64_t> ranks;                   // [source]: of its first key
    std::vector<std::vector<Key>> keys;            // [source]
    std::vector<std::vector<uint32_t>> positions;  // [source]: in the output, of each of its keys
    std::vector<Key> merged;                       // not encoded yet
    LevelPiece encoded;
  };
  // The rest of a source's keys in a piece.
  struct Cursor {
    const Key* at;
    const Key* end;
    bool ended() const { return at == end; }
    // The first 64 bits of the head decide most comparisons.
    uint64_t prefix() const { return ended() ? UINT64_MAX : prefix_of(*at); }
    static uint64_t prefix_of(Brick brick) { return brick; }
    static uint64_t prefix_of(const NodeKey& key) { return uint64_t(key[0]) << 32 | key[1]; }
  };

  // All pieces together take 1/32 of the budget, so that they fit beside maps and blocks. A piece
  // has less than twice as many keys.
  static uint64_t keys_per_piece(const MemoryBudget& budget, size_t workers) {
    return std::clamp<uint64_t>(budget.limit() / 64 / kBytesPerKey / workers, kMinKeysPerPiece,
                                kMaxKeysPerPiece);
  }

  // Takes the next keys off the sources; false if none are left or another worker has failed.
  bool cut(Piece* piece) {
    const std::lock_guard lock(cut_mutex_);
    if (cut_failed_) return false;
    cut_failed_ = true;  // if what follows throws: the sources are invalid then
    check_interrupt();
    piece->number = pieces_++;
    piece->taken = 0;
    piece->keys.resize(sources_.size());
    piece->ranks.clear();
    for (size_t s = 0; s < sources_.size(); ++s) {
      piece->ranks.push_back(sources_[s].taken());
      piece->keys[s].clear();
    }
    while (piece->taken < share_ * sources_.size()) {
      const size_t before = piece->taken;
      const std::optional<Key> bound = next_bound();
      for (size_t s = 0; s < sources_.size(); ++s) {
        const size_t loaded = std::min(share_, sources_[s].loaded());
        const size_t n = bound ? sources_[s].count_up_to(*bound, share_) : loaded;
        sources_[s].take(n, &piece->keys[s]);
        piece->taken += n;
      }
      if (piece->taken == before) break;
    }
    cut_failed_ = false;
    return piece->taken != 0;
  }
  // The greatest key up to which a share of each source suffices; none if that is all.
  std::optional<Key> next_bound() const {
    std::optional<Key> bound;
    for (const LevelSource<Key>& source : sources_) {
      const size_t n = std::min(share_, source.loaded());
      if (!source.has_more_than(n)) continue;
      const Key last = source.key(n - 1);
      if (!bound || last < *bound) bound = last;
    }
    return bound;
  }

  // Merges and encodes the piece.
  void merge(Piece* piece) const {
    std::vector<Cursor> cursors;
    piece->encoded.clear();
    piece->positions.resize(sources_.size());
    for (size_t s = 0; s < sources_.size(); ++s) {
      std::vector<Key>& keys = piece->keys[s];
      sources_[s].rewrite_keys(keys);
      cursors.push_back({keys.data(), keys.data() + keys.size()});
      piece->positions[s].clear();
    }
    const auto prefix = [&](size_t s) { return cursors[s].prefix(); };
    const auto before = [&](size_t a, size_t b) {
      if (cursors[a].ended() || cursors[b].ended()) return !cursors[a].ended();
      return *cursors[a].at < *cursors[b].at;
    };
    Tournament tournament(cursors.size(), prefix, before);
    uint32_t position = 0;
    for (size_t s = tournament.winner(); !cursors[s].ended();) {
      const Key key = *cursors[s].at;
      piece->merged.push_back(key);
      do {
        piece->positions[s].push_back(position);
        ++cursors[s].at;
        tournament.replay();
        s = tournament.winner();
      } while (!cursors[s].ended() && *cursors[s].at == key);
      if (++position % kKeysEncodedAtOnce == 0) encode(piece);
    }
    encode(piece);
  }
  void encode(Piece* piece) const {
    output_->encode(std::span<const Key>(piece->merged), &piece->encoded);
    piece->merged.clear();
  }

  // Puts the piece into the output and its indices into the maps; false if another worker failed.
  bool place(Piece* piece) {
    uint32_t first = 0;  // index
    const bool placed = turns_.run(piece->number, [&] {
      first = output_->append(&piece->encoded);
      if (maps_->spilled()) set_maps(*piece, first);
    });
    if (!placed) return false;
    if (!maps_->spilled()) set_maps(*piece, first);
    output_->store(&piece->encoded);
    return true;
  }
  void set_maps(const Piece& piece, uint32_t first) {
    for (size_t s = 0; s < sources_.size(); ++s) {
      uint64_t rank = piece.ranks[s];
      for (const uint32_t position : piece.positions[s])
        maps_->set(s, rank++, first + piece.encoded.indices[position]);
    }
  }

  std::vector<LevelSource<Key>> sources_;
  Output* output_;
  RankMaps* maps_;
  Executor* executor_;
  size_t share_;  // most keys that a source gives at a time
  MemoryBudget::Reservation reservation_;
  std::mutex cut_mutex_;  // guards the sources and what follows
  bool cut_failed_ = false;
  size_t pieces_ = 0;  // cut so far
  Turns turns_;
};

// Merges with all inputs open. The maps are spilled if `scratch` is given.
template <class Key, class Output>
RankMaps merge_at_once(std::span<const LevelInput<Key>> inputs, Output* output,
                       const MergeProgress& progress, Scratch* scratch, MemoryBudget* budget,
                       Executor* executor) {
  std::vector<uint64_t> counts;
  std::vector<LevelSource<Key>> sources;
  for (const LevelInput<Key>& input : inputs) {
    counts.push_back(input.count());
    sources.push_back(input.open());
  }
  RankMaps maps(counts, scratch, budget);
  LevelMerge<Key, Output>(std::move(sources), output, &maps, budget, executor).run(progress);
  maps.finish();
  return maps;
}

// The output of a group: its keys as they are.
class GroupOutput {
 public:
  GroupOutput(Scratch* scratch, MemoryBudget* budget)
      : writer_(scratch->transient(), scratch->new_streams(), budget) {}

  template <class Key>
  void encode(std::span<const Key> keys, LevelPiece* piece) const {
    piece->add_as_they_are(keys);
  }
  uint32_t append(LevelPiece* piece) {
    writer_.append(piece->bytes);
    const uint64_t first = count_;
    count_ += piece->indices.size();
    as_u32(count_, "nodes in a level of some runs");
    return uint32_t(first);
  }
  void store(LevelPiece*) {}
  SpillStream finish() { return writer_.finish(); }

 private:
  SpillWriter writer_;
  uint64_t count_ = 0;
};

// Like merge_at_once(), with at most `max_sources` inputs open at a time: merges groups of inputs,
// then the merged groups. The maps are spilled.
template <class Key, class Output>
RankMaps merge_in_groups(std::span<const LevelInput<Key>> inputs, Output* output,
                         const MergeProgress& progress, size_t max_sources, Scratch* scratch,
                         MemoryBudget* budget, Executor* executor) {
  if (inputs.size() <= max_sources)
    return merge_at_once<Key>(inputs, output, progress, scratch, budget, executor);
  std::vector<RankMaps> into;  // [group]: maps of its members into the group
  std::vector<SpillStream> merged;
  for (size_t begin = 0; begin < inputs.size(); begin += max_sources) {
    const auto group = inputs.subspan(begin, std::min(max_sources, inputs.size() - begin));
    GroupOutput keys(scratch, budget);
    const auto taken = [&](uint64_t of_group, uint64_t) { progress(of_group, 0); };
    into.push_back(merge_at_once<Key>(group, &keys, taken, scratch, budget, executor));
    merged.push_back(keys.finish());
  }
  std::vector<LevelInput<Key>> groups;
  for (const SpillStream& stream : merged)
    groups.push_back(spilled_input<Key>(scratch->transient(), stream, budget));
  const auto merged_again = [&](uint64_t, uint64_t of_output) { progress(0, of_output); };
  RankMaps out_of =
      merge_in_groups<Key>(groups, output, merged_again, max_sources, scratch, budget, executor);
  for (const SpillStream& stream : merged) scratch->transient()->free(stream);
  RankMaps maps = RankMaps::without_sources(scratch, budget);
  for (size_t g = 0; g < into.size(); ++g) {
    for (size_t s = 0; s < into[g].size(); ++s) maps.append_composed(&into[g], s, out_of, g);
    out_of.free(g);
  }
  return maps;
}

}  // namespace svdag
