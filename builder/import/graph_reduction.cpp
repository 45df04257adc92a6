#include "builder/import/graph_reduction.h"

#include <bit>
#include <vector>

#include "streaming/memory/rank_bitmap.h"
#include "streaming/process/interrupt.h"
#include "streaming/sort/external_sort.h"

namespace svdag {
namespace {

constexpr const char* kReductionPurpose = "nodes of the import";

// A node to be sorted, and the rank of its id among those of its level.
struct BrickRecord {
  Brick key;
  uint32_t rank, unused;
};
struct NodeRecord {
  NodeKey key;
  uint32_t rank, unused[7];
};
static_assert(sizeof(BrickRecord) == 16 && sizeof(NodeRecord) == 64);

struct BrickWord {
  uint32_t operator()(const BrickRecord& r, size_t i) const {
    return uint32_t(r.key >> (i == 0 ? 32 : 0));
  }
};
struct NodeWord {
  uint32_t operator()(const NodeRecord& r, size_t i) const { return r.key[i]; }
};

// Results for the nodes of one level, by rank.
struct ReducedLevel {
  ReducedLevel(uint64_t count, MemoryBudget* budget)
      : reservation(budget->reserve(count * (sizeof(uint32_t) + sizeof(uint64_t)), kReductionPurpose)),
        index(count),
        voxels(count) {}

  MemoryBudget::Reservation reservation;
  HugeVector<uint32_t> index;   // 1 + index in the output; 0: the node is empty
  HugeVector<uint64_t> voxels;  // number of set voxels below the node
};

class GraphReduction {
 public:
  GraphReduction(NodeGraph* graph, const ReductionConfig& config, DagOutput* output)
      : graph_(graph), config_(config), output_(output), brick_level_(graph->grid().levels - 2) {}

  std::vector<ReducedSet> run() {
    const std::vector<uint32_t> roots = graph_->roots();
    mark(roots);
    ReducedLevel below = reduce_bricks();
    for (int level = brick_level_ - 1; level >= 0; --level) below = reduce_nodes(level, below);
    std::vector<ReducedSet> sets;
    for (const uint32_t root : roots) {
      sets.push_back({kNoRoot, 0});
      if (root == kNoChild) continue;
      const uint32_t rank = marks_[0].rank(root);
      if (below.index[rank] != 0) sets.back() = {below.index[rank] - 1, below.voxels[rank]};
    }
    return sets;
  }

 private:
  void mark(const std::vector<uint32_t>& roots) {
    for (int level = 0; level <= brick_level_; ++level)
      marks_.emplace_back(config_.budget, "marks of reached nodes");
    for (const uint32_t root : roots) {
      if (root != kNoChild) marks_[0].set(root);
    }
    for (int level = 0; level <= brick_level_; ++level) {
      marks_[size_t(level)].seal();
      if (level == brick_level_) break;
      for_each_id(level, [&](uint32_t, uint32_t id) {
        for (const uint32_t child : graph_->children(level, id)) {
          if (child != kNoChild) marks_[size_t(level) + 1].set(child);
        }
      });
    }
  }

  // Calls visit(rank, id) for all marked ids of a level.
  template <class Visit>
  void for_each_id(int level, const Visit& visit) const {
    uint32_t rank = 0;
    marks_[size_t(level)].for_each([&](uint32_t id) {
      if (rank % 65536 == 0) check_interrupt();
      visit(rank++, id);
    });
  }

  ReducedLevel reduce_bricks() {
    const uint64_t count = marks_[size_t(brick_level_)].count();
    ReducedLevel level(count, config_.budget);
    ExternalSort<BrickRecord, BrickWord> sort(sort_room(count * sizeof(BrickRecord)), 2, {});
    for_each_id(brick_level_, [&](uint32_t rank, uint32_t id) {
      const Brick brick = graph_->brick(id);
      level.index[rank] = 0;
      level.voxels[rank] = uint64_t(std::popcount(brick));
      if (brick != 0) sort.push({brick, rank, 0});
    });
    output_->begin_level(brick_level_);
    write(&sort, &level, [this](Brick brick) { return output_->add_brick(brick); });
    return level;
  }

  ReducedLevel reduce_nodes(int number, const ReducedLevel& below) {
    const uint64_t count = marks_[size_t(number)].count();
    const RankBitmap& ranks = marks_[size_t(number) + 1];
    ReducedLevel level(count, config_.budget);
    ExternalSort<NodeRecord, NodeWord> sort(sort_room(count * sizeof(NodeRecord)), 8, {});
    for_each_id(number, [&](uint32_t rank, uint32_t id) {
      const std::array<uint32_t, 8> children = graph_->children(number, id);
      NodeRecord record{{}, rank, {}};
      level.index[rank] = 0;
      level.voxels[rank] = 0;
      for (size_t c = 0; c < 8; ++c) {
        if (children[c] == kNoChild) continue;
        const uint32_t child = ranks.rank(children[c]);
        record.key[c] = below.index[child];
        level.voxels[rank] += below.voxels[child];
      }
      if (level.voxels[rank] != 0) sort.push(record);
    });
    output_->begin_level(number);
    write(&sort, &level, [this](const NodeKey& key) { return output_->add_node(key); });
    return level;
  }

  // Finishes the sort and adds each distinct key to the output; equal keys get one index.
  template <class Sort, class Add>
  void write(Sort* sort, ReducedLevel* level, const Add& add) {
    uint32_t index = 0;
    bool any = false;
    decltype(first_key(*sort)) last{};
    sort->finish([&](const auto& records) {
      check_interrupt();
      for (const auto& record : records) {
        if (!any || record.key != last) index = 1 + add(record.key);
        any = true;
        last = record.key;
        level->index[record.rank] = index;
      }
    });
  }
  template <class Word>
  static Brick first_key(const ExternalSort<BrickRecord, Word>&);
  template <class Word>
  static NodeKey first_key(const ExternalSort<NodeRecord, Word>&);

  // Buffers for `bytes` bytes of records, at most config_.sort_bytes.
  ExternalSortConfig sort_room(uint64_t bytes) const {
    const uint64_t min = 2 * config_.executor->workers() * ExternalSortConfig::kMinBytesPerWorker;
    const uint64_t max = std::max(config_.sort_bytes, min);
    return {config_.budget, std::clamp(2 * bytes + min, min, max), config_.executor,
            config_.new_file};
  }

  NodeGraph* graph_;
  const ReductionConfig& config_;
  DagOutput* output_;
  int brick_level_;
  std::vector<RankBitmap> marks_;  // [level]: ids that the roots reach
};

}  // namespace

std::vector<ReducedSet> reduce_graph(NodeGraph* graph, const ReductionConfig& config,
                                     DagOutput* output) {
  return GraphReduction(graph, config, output).run();
}

}  // namespace svdag
