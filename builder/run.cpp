#include "builder/run.h"

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

// Room for sorting, kept from level to level.
template <class Key>
struct SortRoom {
  HugeVector<Numbered<Key>> records, scratch;

  void make(size_t count) {
    records.clear();  // so that growing moves nothing
    scratch.clear();
    records.resize(count);
    scratch.resize(count);
  }

  // The records sorted into *keys; returns the rank of each number.
  HugeVector<uint32_t> sort_into(HugeVector<Key>* keys) {
    radix_sort(
        std::span(records), sizeof(Key) / 4,
        [](const Numbered<Key>& r, size_t i) { return key_word(r, i); }, &scratch);
    HugeVector<uint32_t> ranks(records.size());
    keys->resize(records.size());
    for (uint32_t i = 0; i < records.size(); ++i) {
      (*keys)[i] = records[i].key;
      ranks[records[i].number] = i;
    }
    return ranks;
  }
};

}  // namespace

Run freeze(NodeTable* table, Ranks* ranks) {
  table->close();
  const int brick_level = table->brick_level();
  Run run;
  run.nodes.resize(size_t(brick_level));
  ranks->resize(size_t(brick_level) + 1);
  {
    SortRoom<Brick> room;
    room.make(table->size(brick_level));
    for (uint32_t i = 0; i < room.records.size(); ++i) room.records[i] = {table->brick(i), i};
    table->clear(brick_level);
    (*ranks)[size_t(brick_level)] = room.sort_into(&run.bricks);
  }
  SortRoom<NodeKey> room;
  for (int level = brick_level - 1; level >= 0; --level) {
    const HugeVector<uint32_t>& below = (*ranks)[size_t(level) + 1];
    room.make(table->size(level));
    for (uint32_t i = 0; i < room.records.size(); ++i) {
      room.records[i] = {table->node(level, i), i};
      for (uint32_t& child : room.records[i].key) child = child == 0 ? 0 : 1 + below[child - 1];
    }
    table->clear(level);
    (*ranks)[size_t(level)] = room.sort_into(&run.nodes[size_t(level)]);
  }
  return run;
}

}  // namespace svdag
