#include "builder/reduce/run.h"

#include <algorithm>
#include <array>
#include <bit>

#include "streaming/process/interrupt.h"
#include "streaming/sort/radix_sort.h"

namespace svdag {
namespace {

constexpr const char* kPurpose = "sorting of nodes";

// Sorted instead of a key, which stays where it is: the first 96 bits of the key's code, and its
// number.
struct SortRecord {
  uint64_t high;
  uint32_t low;
  uint32_t number;

  uint32_t word(size_t i) const noexcept {
    return i == 2 ? low : uint32_t(high >> (i == 0 ? 32 : 0));
  }
};

// Keys are in the order of their codes: a 0 for an absent child, a 1 and 1 + the rank in
// `rank_bits` bits for any other. 96 bits hold about 4 children, which decide almost all orders.
// Each child pushes the ones after it to the right, out of the code at last: there is no branch to
// mispredict.
SortRecord record_of(const NodeKey& key, uint32_t number, int rank_bits) noexcept {
  uint64_t high = 0, low = 0;
  for (size_t c = 8; c-- > 0;) {
    const uint64_t present = -uint64_t(key[c] != 0);
    const uint64_t bits = present & (uint64_t(1) << rank_bits | key[c]);
    const int length = 1 + int(present & uint64_t(rank_bits));
    low = low >> length | high << (64 - length);
    high = high >> length | bits << (64 - length);
  }
  return {high, uint32_t(low >> 32), number};
}
SortRecord record_of(Brick brick, uint32_t number, int) noexcept {
  return {brick, 0, number};
}

using Marks = std::vector<std::vector<bool>>;  // [level][1 + number]; [level][0] says nothing

// What the roots reach, from the top down.
Marks reached(const NodeTable& table, std::span<SubDagRoot> roots) {
  Marks marks;
  for (int level = 0; level <= table.brick_level(); ++level)
    marks.emplace_back(1 + table.size(level), false);
  for (const SubDagRoot& root : roots) marks[size_t(root.level)][1 + root.rank] = true;
  for (int level = 0; level < table.brick_level(); ++level) {
    std::vector<bool>& below = marks[size_t(level) + 1];
    for (uint32_t i = 0; i < table.size(level); ++i) {
      if (!marks[size_t(level)][1 + i]) continue;
      for (const uint32_t child : table.node(level, i)) below[child] = true;
    }
  }
  return marks;
}

// Sorts the levels of one table, from the bricks up.
class Freezer {
 public:
  Freezer(NodeTable* table, std::span<SubDagRoot> roots, const SpillTarget* target)
      : table_(table),
        roots_(roots),
        target_(target),
        marks_(reached(*table, roots)),
        room_(table->budget()->reserve(0, kPurpose)) {}

  Run run() {
    const int brick_level = table_->brick_level();
    Run run;
    run.nodes.resize(size_t(brick_level));
    sort(brick_level, table_->take_bricks(), &run.bricks);
    for (int level = brick_level - 1; level >= 0; --level) {
      SegmentedArray<NodeKey> nodes = table_->take_nodes(level);
      for (size_t i = 0; i < nodes.size(); ++i) {
        if (!marks_[size_t(level)][1 + i]) continue;
        for (uint32_t& child : nodes[i]) child = ranks_[child];
      }
      sort(level, std::move(nodes), &run.nodes[size_t(level)]);
    }
    return run;
  }

 private:
  // Sorts the marked ones of `keys`, whose children are ranks, into *out, and sets ranks_.
  template <class Key>
  void sort(int level, SegmentedArray<Key> keys, RunLevel<Key>* out) {
    check_interrupt();
    const HugeVector<uint32_t> order = sorted_numbers(level, keys);
    const size_t numbers = keys.size();
    MemoryBudget* const budget = table_->budget();
    std::optional<SpillWriter> writer;
    if (target_ != nullptr) {
      writer.emplace(target_->file, target_->first_stream + uint64_t(level), budget);
    } else {
      out->reservation = budget->reserve(order.size() * sizeof(Key), kPurpose);
      out->keys.resize(order.size());
    }
    for (size_t i = 0; i < order.size(); ++i) {
      constexpr size_t kAhead = 16;
      if (i + kAhead < order.size()) keys.prefetch(order[i + kAhead]);
      const Key& key = keys[order[i]];
      writer ? writer->append(std::as_bytes(std::span(&key, 1))) : void(out->keys[i] = key);
    }
    if (writer) out->spilled = writer->finish();
    keys.clear();
    ranks_ = HugeVector<uint32_t>(1 + numbers);
    ranks_[0] = 0;
    for (size_t i = 0; i < order.size(); ++i) ranks_[1 + order[i]] = uint32_t(1 + i);
    for (SubDagRoot& root : roots_) {
      if (root.level == level) root.rank = ranks_[1 + root.rank] - 1;
    }
  }

  // The numbers of the marked keys, in the order of the keys. The last use of ranks_.
  template <class Key>
  HugeVector<uint32_t> sorted_numbers(int level, const SegmentedArray<Key>& keys) {
    const std::vector<bool>& marks = marks_[size_t(level)];
    const int rank_bits = int(std::bit_width(ranks_.size()));
    const size_t count = size_t(std::count(marks.begin() + 1, marks.end(), true));
    room_.resize(2 * count * sizeof(SortRecord), kPurpose);
    HugeVector<SortRecord> records(count), scratch(count);
    size_t next = 0;
    for (uint32_t i = 0; i < keys.size(); ++i) {
      if (marks[1 + i]) records[next++] = record_of(keys[i], i, rank_bits);
    }
    const auto word = [](const SortRecord& r, size_t i) { return r.word(i); };
    radix_sort(std::span(records), 3, word, &scratch);
    const auto less = [&](const SortRecord& a, const SortRecord& b) {
      return keys[a.number] < keys[b.number];
    };
    const auto tie = [](const SortRecord& a, const SortRecord& b) {
      return a.high == b.high && a.low == b.low;
    };
    for (size_t begin = 0, end; begin < count; begin = end) {
      for (end = begin + 1; end < count && tie(records[end], records[begin]);) ++end;
      if (end - begin > 1) std::sort(&records[begin], &records[begin] + (end - begin), less);
    }
    ranks_ = {};
    scratch = {};
    HugeVector<uint32_t> numbers(count);
    for (size_t i = 0; i < count; ++i) numbers[i] = records[i].number;
    records = {};
    room_.resize(2 * count * sizeof(uint32_t), kPurpose);  // these, and the ranks
    return numbers;
  }

  NodeTable* table_;
  std::span<SubDagRoot> roots_;
  const SpillTarget* target_;
  Marks marks_;
  MemoryBudget::Reservation room_;  // of the records
  HugeVector<uint32_t> ranks_;      // 1 + rank by 1 + number, of the level sorted last; 0 by 0
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
