#include "builder/run.h"

#include <algorithm>

#include "streaming/radix_sort.h"

namespace svdag {
namespace {

template <class Key>
struct Numbered {
  Key key;
  uint32_t number;
};

uint32_t key_word(const Numbered<Brick>& record, size_t i) {
  return uint32_t(record.key >> (i == 0 ? 32 : 0));
}
uint32_t key_word(const Numbered<NodeKey>& record, size_t i) {
  return record.key[i];
}

using Marks = std::vector<std::vector<bool>>;  // [level][number]

// What the roots reach, from the top down.
Marks reached(const NodeTable& table, std::span<const NodeNumber> roots) {
  Marks marks;
  for (int level = 0; level <= table.brick_level(); ++level)
    marks.emplace_back(table.size(level), false);
  for (const NodeNumber& root : roots) marks[size_t(root.level)][root.number] = true;
  for (int level = 0; level < table.brick_level(); ++level) {
    std::vector<bool>& below = marks[size_t(level) + 1];
    for (uint32_t i = 0; i < table.size(level); ++i) {
      if (!marks[size_t(level)][i]) continue;
      for (const uint32_t child : table.node(level, i)) {
        if (child != 0) below[child - 1] = true;
      }
    }
  }
  return marks;
}

// Room for sorting, kept from level to level.
template <class Key>
struct SortRoom {
  HugeVector<Numbered<Key>> records, scratch;

  // key_of(number) for the numbers that are marked.
  template <class KeyOf>
  void make(const std::vector<bool>& marks, const KeyOf& key_of) {
    const size_t count = size_t(std::count(marks.begin(), marks.end(), true));
    records.clear();  // so that growing moves nothing
    scratch.clear();
    records.resize(count);
    scratch.resize(count);
    size_t next = 0;
    for (uint32_t i = 0; i < marks.size(); ++i) {
      if (marks[i]) records[next++] = {key_of(i), i};
    }
  }

  // The records sorted into *keys; returns the rank of each of `numbers` numbers.
  HugeVector<uint32_t> sort_into(HugeVector<Key>* keys, size_t numbers) {
    radix_sort(
        std::span(records), sizeof(Key) / 4,
        [](const Numbered<Key>& r, size_t i) { return key_word(r, i); }, &scratch);
    HugeVector<uint32_t> ranks(numbers);
    keys->resize(records.size());
    for (uint32_t i = 0; i < records.size(); ++i) {
      (*keys)[i] = records[i].key;
      ranks[records[i].number] = i;
    }
    return ranks;
  }
};

}  // namespace

Run freeze(NodeTable* table, std::span<const NodeNumber> roots, Ranks* ranks) {
  table->close();
  const Marks marks = reached(*table, roots);
  const int brick_level = table->brick_level();
  Run run;
  run.nodes.resize(size_t(brick_level));
  ranks->resize(size_t(brick_level) + 1);
  {
    SortRoom<Brick> room;
    const std::vector<bool>& own = marks[size_t(brick_level)];
    room.make(own, [&](uint32_t i) { return table->brick(i); });
    table->clear(brick_level);
    (*ranks)[size_t(brick_level)] = room.sort_into(&run.bricks, own.size());
  }
  SortRoom<NodeKey> room;
  for (int level = brick_level - 1; level >= 0; --level) {
    const HugeVector<uint32_t>& below = (*ranks)[size_t(level) + 1];
    const std::vector<bool>& own = marks[size_t(level)];
    room.make(own, [&](uint32_t i) {
      NodeKey key = table->node(level, i);
      for (uint32_t& child : key) child = child == 0 ? 0 : 1 + below[child - 1];
      return key;
    });
    table->clear(level);
    (*ranks)[size_t(level)] = room.sort_into(&run.nodes[size_t(level)], own.size());
  }
  return run;
}

}  // namespace svdag
