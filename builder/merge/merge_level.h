// The k-way merge of one level: merges ascending sources with unique keys into one, and returns for
// every source the map from its ranks to indices in the output.
#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "builder/merge/level_source.h"
#include "builder/merge/rank_maps.h"
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

// The k-way merge of one level, in rounds. A round takes from every source the keys up to a bound
// that is in memory for all of them, cuts them at splitters into pieces, and merges these at once.
// Equal keys are in one piece. Pieces are written in order, while later ones are merged.
// Rejected: one range of keys per worker (the second could only be written after the first).
template <class Key, class Add>
class LevelMerge {
 public:
  // `add`, `maps`: as in merge_at_once(). Runs the tasks of a round on `executor`.
  LevelMerge(std::vector<LevelSource<Key>> sources, const Add& add, RankMaps* maps,
             MemoryBudget* budget, Executor* executor)
      : sources_(std::move(sources)),
        add_(add),
        maps_(maps),
        executor_(executor),
        share_(keys_per_round(budget, executor->workers()) / std::max<size_t>(sources_.size(), 1) +
               1),
        reservation_(budget->reserve(
            share_ * sources_.size() * (2 * sizeof(Key) + sizeof(uint32_t)), "merge buffers")),
        buffers_(executor->workers()) {}

  void run() {
    while (load()) {
      check_interrupt();
      cut();
      Turns turns;
      executor_->for_each(cuts_.size() - 1, [&](size_t worker, size_t piece) {
        try {
          merge_piece(piece, &buffers_[worker]);
          turns.run(piece, [&] { write(buffers_[worker]); });
        } catch (...) {
          turns.fail();
          throw;
        }
      });
      for (size_t s = 0; s < sources_.size(); ++s) sources_[s].consume(cuts_.back()[s]);
    }
  }

 private:
  static constexpr uint64_t kMinKeysPerRound = 1 << 10, kMaxKeysPerWorker = 1 << 16;
  static constexpr size_t kMinKeysPerPiece = 1 << 12;
  static constexpr size_t kPiecesPerWorker = 4;

  // A merged piece.
  struct Buffer {
    std::vector<Key> keys;                         // unique
    std::vector<std::vector<uint32_t>> positions;  // [source]: in `keys`, of each of its keys
    std::vector<uint32_t> indices;                 // of `keys`, in the output
  };
  // The rest of a source's part of a piece.
  struct Cursor {
    const Key* at;
    const Key* end;
    bool ended() const { return at == end; }
    // The first 64 bits of the head decide most comparisons.
    uint64_t prefix() const { return ended() ? UINT64_MAX : prefix_of(*at); }
    static uint64_t prefix_of(Brick brick) { return brick; }
    static uint64_t prefix_of(const NodeKey& key) { return uint64_t(key[0]) << 32 | key[1]; }
  };

  // 1/32 of the budget, so that buffers fit beside maps and blocks.
  static uint64_t keys_per_round(const MemoryBudget* budget, size_t workers) {
    return std::clamp<uint64_t>(budget->limit() / 64 / sizeof(Key), kMinKeysPerRound,
                                kMaxKeysPerWorker * workers);
  }

  // Loads the next keys of every source; false if none is left.
  bool load() {
    const bool reads = std::any_of(sources_.begin(), sources_.end(),
                                   [](const auto& source) { return source.reads(); });
    const auto refill = [&](size_t, size_t s) { sources_[s].refill(share_); };
    if (reads) {
      executor_->for_each(sources_.size(), refill);
    } else {
      for (size_t s = 0; s < sources_.size(); ++s) refill(0, s);
    }
    return std::any_of(sources_.begin(), sources_.end(),
                       [](const auto& source) { return !source.window().empty(); });
  }

  // Sets cuts_[p][s], where piece p begins in the window of source s; cuts_.back() is the end of
  // the round.
  void cut() {
    const Key* bound = nullptr;  // all keys up to it are in the windows
    for (const LevelSource<Key>& source : sources_) {
      if (source.has_more() && (bound == nullptr || source.window().back() < *bound))
        bound = &source.window().back();
    }
    std::vector<size_t> ends;
    size_t total = 0, longest = 0;
    for (size_t s = 0; s < sources_.size(); ++s) {
      const std::span<const Key> keys = sources_[s].window();
      ends.push_back(bound == nullptr ? keys.size()
                                      : size_t(std::upper_bound(keys.begin(), keys.end(), *bound) -
                                               keys.begin()));
      total += ends[s];
      if (ends[s] > ends[longest]) longest = s;
    }
    const size_t pieces =
        std::clamp<size_t>(total / kMinKeysPerPiece, 1, kPiecesPerWorker * executor_->workers());
    cuts_.assign(1, std::vector<size_t>(sources_.size(), 0));
    for (size_t p = 1; p < pieces; ++p) {
      const Key& splitter = sources_[longest].window()[ends[longest] * p / pieces];
      cuts_.push_back({});
      for (size_t s = 0; s < sources_.size(); ++s) {
        const std::span<const Key> keys = sources_[s].window().first(ends[s]);
        cuts_.back().push_back(
            size_t(std::lower_bound(keys.begin(), keys.end(), splitter) - keys.begin()));
      }
    }
    cuts_.push_back(std::move(ends));
  }

  void merge_piece(size_t piece, Buffer* out) {
    std::vector<Cursor> cursors;
    out->keys.clear();
    out->positions.resize(sources_.size());
    for (size_t s = 0; s < sources_.size(); ++s) {
      const Key* const window = sources_[s].window().data();
      cursors.push_back({window + cuts_[piece][s], window + cuts_[piece + 1][s]});
      out->positions[s].clear();
    }
    const auto prefix = [&](size_t s) { return cursors[s].prefix(); };
    const auto before = [&](size_t a, size_t b) {
      if (cursors[a].ended() || cursors[b].ended()) return !cursors[a].ended();
      return *cursors[a].at < *cursors[b].at;
    };
    Tournament tournament(cursors.size(), prefix, before);
    for (size_t s = tournament.winner(); !cursors[s].ended();) {
      const Key key = *cursors[s].at;
      const uint32_t position = uint32_t(out->keys.size());
      out->keys.push_back(key);
      do {
        out->positions[s].push_back(position);
        ++cursors[s].at;
        tournament.replay();
        s = tournament.winner();
      } while (!cursors[s].ended() && *cursors[s].at == key);
    }
  }

  void write(Buffer& piece) {
    piece.indices.clear();
    for (const Key& key : piece.keys) piece.indices.push_back(add_(key));
    for (size_t s = 0; s < sources_.size(); ++s) {
      for (const uint32_t position : piece.positions[s]) maps_->push(s, piece.indices[position]);
    }
  }

  std::vector<LevelSource<Key>> sources_;
  const Add& add_;
  RankMaps* maps_;
  Executor* executor_;
  size_t share_;  // number of keys of one source that are loaded for a round
  MemoryBudget::Reservation reservation_;
  std::vector<std::vector<size_t>> cuts_;  // of the current round
  std::vector<Buffer> buffers_;            // [worker]
};

// Merges with all inputs open. add(key) appends a key to the output and returns its index there; it
// is called by one thread at a time. The maps are spilled if `scratch` is given.
template <class Key, class Add>
RankMaps merge_at_once(std::span<const LevelInput<Key>> inputs, const Add& add, Scratch* scratch,
                       MemoryBudget* budget, Executor* executor) {
  std::vector<uint64_t> counts;
  std::vector<LevelSource<Key>> sources;
  for (const LevelInput<Key>& input : inputs) {
    counts.push_back(input.count());
    sources.push_back(input.open());
  }
  RankMaps maps(counts, scratch, budget);
  LevelMerge<Key, Add>(std::move(sources), add, &maps, budget, executor).run();
  maps.finish();
  return maps;
}

// Like merge_at_once(), with at most `max_sources` inputs open at a time: merges groups of inputs,
// then the merged groups. The maps are spilled.
template <class Key, class Add>
RankMaps merge_in_groups(std::span<const LevelInput<Key>> inputs, const Add& add,
                         size_t max_sources, Scratch* scratch, MemoryBudget* budget,
                         Executor* executor) {
  if (inputs.size() <= max_sources)
    return merge_at_once<Key>(inputs, add, scratch, budget, executor);
  std::vector<RankMaps> into;  // [group]: maps of its members into the group
  std::vector<SpillStream> merged;
  for (size_t begin = 0; begin < inputs.size(); begin += max_sources) {
    SpillWriter writer(scratch->transient(), scratch->new_streams(), budget);
    uint64_t next = 0;
    const auto append = [&](const Key& key) {
      writer.append(std::as_bytes(std::span(&key, 1)));
      return as_u32(next++, "nodes in a level of some runs");
    };
    const auto group = inputs.subspan(begin, std::min(max_sources, inputs.size() - begin));
    into.push_back(merge_at_once<Key>(group, append, scratch, budget, executor));
    merged.push_back(writer.finish());
  }
  std::vector<LevelInput<Key>> groups;
  for (const SpillStream& stream : merged)
    groups.push_back(spilled_input<Key>(scratch->transient(), stream, budget));
  RankMaps out_of = merge_in_groups<Key>(groups, add, max_sources, scratch, budget, executor);
  for (const SpillStream& stream : merged) scratch->transient()->free(stream);
  RankMaps maps = RankMaps::without_sources(scratch, budget);
  for (size_t g = 0; g < into.size(); ++g) {
    for (size_t s = 0; s < into[g].size(); ++s) maps.append_composed(&into[g], s, out_of, g);
    out_of.free(g);
  }
  return maps;
}

}  // namespace svdag
