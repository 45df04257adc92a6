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
#include "streaming/process/interrupt.h"
#include "streaming/sort/tournament.h"

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
    return blocks ? LevelSource<Key>(blocks(), map) : LevelSource<Key>(keys);
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

// Merges with all inputs open. add(key) appends a key to the output and returns its index there.
// The maps are spilled if `scratch` is given.
template <class Key, class Add>
RankMaps merge_at_once(std::span<const LevelInput<Key>> inputs, const Add& add, Scratch* scratch,
                       MemoryBudget* budget) {
  constexpr uint64_t kKeysPerCheck = 1 << 16;  // keys between two interrupt checks
  std::vector<uint64_t> counts;
  std::vector<LevelSource<Key>> sources;
  for (const LevelInput<Key>& input : inputs) {
    counts.push_back(input.count());
    sources.push_back(input.open());
  }
  RankMaps maps(counts, scratch, budget);
  const auto prefix = [&](size_t s) { return sources[s].prefix(); };
  const auto before = [&](size_t a, size_t b) { return sources[a].before(sources[b]); };
  Tournament tournament(sources.size(), prefix, before);
  uint64_t merged = 0;
  for (size_t s = tournament.winner(); !sources[s].ended();) {
    if (++merged % kKeysPerCheck == 0) check_interrupt();
    const Key key = sources[s].head();
    const uint32_t index = add(key);
    do {
      maps.push(s, index);
      sources[s].advance();
      tournament.replay();
      s = tournament.winner();
    } while (!sources[s].ended() && sources[s].head() == key);
  }
  maps.finish();
  return maps;
}

// Like merge_at_once(), with at most `max_sources` inputs open at a time: merges groups of inputs,
// then the merged groups. The maps are spilled.
template <class Key, class Add>
RankMaps merge_in_groups(std::span<const LevelInput<Key>> inputs, const Add& add,
                         size_t max_sources, Scratch* scratch, MemoryBudget* budget) {
  if (inputs.size() <= max_sources) return merge_at_once<Key>(inputs, add, scratch, budget);
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
    into.push_back(merge_at_once<Key>(group, append, scratch, budget));
    merged.push_back(writer.finish());
  }
  std::vector<LevelInput<Key>> groups;
  for (const SpillStream& stream : merged)
    groups.push_back(spilled_input<Key>(scratch->transient(), stream, budget));
  RankMaps out_of = merge_in_groups<Key>(groups, add, max_sources, scratch, budget);
  for (const SpillStream& stream : merged) scratch->transient()->free(stream);
  RankMaps maps = RankMaps::without_sources(scratch, budget);
  for (size_t g = 0; g < into.size(); ++g) {
    for (size_t s = 0; s < into[g].size(); ++s) maps.append_composed(&into[g], s, out_of, g);
    out_of.free(g);
  }
  return maps;
}

}  // namespace svdag
