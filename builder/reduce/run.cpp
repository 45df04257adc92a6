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
  std::array<uint32_t, 3> prefix;
  uint32_t number;
};

// Keys are in the order of their codes: a 0 for an absent child, a 1 and the rank in `rank_bits`
// bits for any other. 96 bits hold about 4 children, which decide almost all orders.
SortRecord record_of(const NodeKey& key, uint32_t number, int rank_bits) noexcept {
  unsigned __int128 code = 0;
  int left = 96;
  for (const uint32_t child : key) {
    const int length = child == 0 ? 1 : 1 + rank_bits;
    const uint64_t bits = child == 0 ? 0 : uint64_t(1) << rank_bits | (child - 1);
    left -= length;
    if (left <= 0) {
      code |= bits >> -left;
      break;
    }
    code |= static_cast<unsigned __int128>(bits) << left;
  }
  return {{uint32_t(code >> 64), uint32_t(code >> 32), uint32_t(code)}, number};
}
SortRecord record_of(Brick brick, uint32_t number, int) noexcept {
  return {{uint32_t(brick >> 32), uint32_t(brick), 0}, number};
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
        if (!marks_[size_t(level)][i]) continue;
        for (uint32_t& child : nodes[i]) child = child == 0 ? 0 : 1 + ranks_[child - 1];
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
    ranks_ = HugeVector<uint32_t>(numbers);
    for (size_t i = 0; i < order.size(); ++i) ranks_[order[i]] = uint32_t(i);
    for (SubDagRoot& root : roots_) {
      if (root.level == level) root.rank = ranks_[root.rank];
    }
  }

  // The numbers of the marked keys, in the order of the keys. The last use of ranks_.
  template <class Key>
  HugeVector<uint32_t> sorted_numbers(int level, const SegmentedArray<Key>& keys) {
    const std::vector<bool>& marks = marks_[size_t(level)];
    const int rank_bits = int(std::bit_width(ranks_.size()));
    const size_t count = size_t(std::count(marks.begin(), marks.end(), true));
    room_.resize(2 * count * sizeof(SortRecord), kPurpose);
    HugeVector<SortRecord> records(count), scratch(count);
    size_t next = 0;
    for (uint32_t i = 0; i < marks.size(); ++i) {
      if (marks[i]) records[next++] = record_of(keys[i], i, rank_bits);
    }
    const auto word = [](const SortRecord& r, size_t i) { return r.prefix[i]; };
    radix_sort(std::span(records), 3, word, &scratch);
    const auto less = [&](const SortRecord& a, const SortRecord& b) {
      return keys[a.number] < keys[b.number];
    };
    for (size_t begin = 0, end; begin < count; begin = end) {
      for (end = begin + 1; end < count && records[end].prefix == records[begin].prefix;) ++end;
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
  HugeVector<uint32_t> ranks_;      // by number, of the level sorted last
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
