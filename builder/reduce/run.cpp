#include "builder/reduce/run.h"

#include <algorithm>

#include "streaming/process/interrupt.h"
#include "streaming/sort/radix_sort.h"

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
Marks reached(const NodeTable& table, std::span<SubDagRoot> roots) {
  Marks marks;
  for (int level = 0; level <= table.brick_level(); ++level)
    marks.emplace_back(table.size(level), false);
  for (const SubDagRoot& root : roots) marks[size_t(root.level)][root.rank] = true;
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
class SortRoom {
 public:
  explicit SortRoom(MemoryBudget* budget)
      : budget_(budget), reservation_(budget->reserve(0, kPurpose)) {}

  // key_of(number) for the numbers that are marked.
  template <class KeyOf>
  void make(const std::vector<bool>& marks, const KeyOf& key_of) {
    const size_t count = size_t(std::count(marks.begin(), marks.end(), true));
    if (count > records_.capacity()) {
      records_ = {};  // so that growing moves nothing
      scratch_ = {};
      reservation_.resize(2 * count * sizeof(Numbered<Key>), kPurpose);
    }
    records_.resize(count);
    scratch_.resize(count);
    size_t next = 0;
    for (uint32_t i = 0; i < marks.size(); ++i) {
      if (marks[i]) records_[next++] = {key_of(i), i};
    }
  }

  // The records sorted into *level; returns the rank of each of `numbers` numbers.
  HugeVector<uint32_t> sort_into(RunLevel<Key>* level, size_t numbers, SpillWriter* writer) {
    radix_sort(
        std::span(records_), sizeof(Key) / 4,
        [](const Numbered<Key>& r, size_t i) { return key_word(r, i); }, &scratch_);
    HugeVector<uint32_t> ranks(numbers);
    if (writer == nullptr) {
      level->reservation = budget_->reserve(records_.size() * sizeof(Key), kPurpose);
      level->keys.resize(records_.size());
    }
    for (uint32_t i = 0; i < records_.size(); ++i) {
      if (writer == nullptr) {
        level->keys[i] = records_[i].key;
      } else {
        writer->append(std::as_bytes(std::span(&records_[i].key, 1)));
      }
      ranks[records_[i].number] = i;
    }
    if (writer != nullptr) level->spilled = writer->finish();
    return ranks;
  }

 private:
  static constexpr const char* kPurpose = "sorting of nodes";

  MemoryBudget* budget_;
  HugeVector<Numbered<Key>> records_, scratch_;
  MemoryBudget::Reservation reservation_;
};

// Sorts the levels of one table, from the bricks up.
class Freezer {
 public:
  Freezer(NodeTable* table, std::span<SubDagRoot> roots, const SpillTarget* target)
      : table_(table), roots_(roots), target_(target), marks_(reached(*table, roots)) {}

  Run run() {
    const int brick_level = table_->brick_level();
    Run run;
    run.nodes.resize(size_t(brick_level));
    {
      SortRoom<Brick> room(table_->budget());
      sort(&room, brick_level, &run.bricks, [&](uint32_t i) { return table_->brick(i); });
    }
    SortRoom<NodeKey> room(table_->budget());
    for (int level = brick_level - 1; level >= 0; --level) {
      sort(&room, level, &run.nodes[size_t(level)], [&](uint32_t i) {
        NodeKey key = table_->node(level, i);
        for (uint32_t& child : key) child = child == 0 ? 0 : 1 + ranks_[child - 1];
        return key;
      });
    }
    return run;
  }

 private:
  template <class Key, class KeyOf>
  void sort(SortRoom<Key>* room, int level, RunLevel<Key>* out, const KeyOf& key_of) {
    check_interrupt();
    const std::vector<bool>& own = marks_[size_t(level)];
    room->make(own, key_of);
    table_->clear(level);
    std::optional<SpillWriter> writer;
    if (target_ != nullptr)
      writer.emplace(target_->file, target_->first_stream + uint64_t(level), table_->budget());
    ranks_ = room->sort_into(out, own.size(), writer ? &*writer : nullptr);
    for (SubDagRoot& root : roots_) {
      if (root.level == level) root.rank = ranks_[root.rank];
    }
  }

  NodeTable* table_;
  std::span<SubDagRoot> roots_;
  const SpillTarget* target_;
  Marks marks_;
  HugeVector<uint32_t> ranks_;  // by number, of the level sorted last
};

}  // namespace

Run freeze(NodeTable* table, std::span<SubDagRoot> roots, const SpillTarget* target) {
  table->close();
  return Freezer(table, roots, target).run();
}

uint64_t freeze_bytes(const NodeTable& table) {
  uint64_t nodes = 0;
  for (int level = 0; level < table.brick_level(); ++level) nodes += table.size(level);
  return kFreezeBytesPerBrick * table.size(table.brick_level()) + kFreezeBytesPerNode * nodes;
}

}  // namespace svdag
