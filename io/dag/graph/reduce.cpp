#include "io/dag/graph/reduce.h"

#include <algorithm>
#include <bit>
#include <optional>
#include <vector>

#include "streaming/error.h"
#include "streaming/memory/rank_bitmap.h"
#include "streaming/process/interrupt.h"
#include "streaming/sort/external_sort.h"

namespace svdag {
namespace {

// A node to be sorted, with its number among those of its level in use.
struct BrickRecord {
  Brick key;
  uint32_t rank, is_unique;
};
struct NodeRecord {
  NodeKey key;
  uint32_t rank, is_unique, unused[6];  // the sort takes records of 2^k bytes
};
static_assert(sizeof(BrickRecord) == 16 && sizeof(NodeRecord) == 64);

struct BrickRecordWord {
  uint32_t operator()(const BrickRecord& r, size_t i) const {
    return uint32_t(r.key >> (i == 0 ? 32 : 0));
  }
};
struct NodeRecordWord {
  uint32_t operator()(const NodeRecord& r, size_t i) const { return r.key[i]; }
};

bool is_empty(Brick key) {
  return key == 0;
}
bool is_empty(const NodeKey& key) {
  return key == NodeKey{};
}

class Reduction {
 public:
  Reduction(NodeGraph* graph, const WorkRoom& room, Executor* executor, DagWriter* writer)
      : graph_(graph),
        facts_(graph->facts()),
        room_(room),
        executor_(executor),
        writer_(writer),
        brick_level_(graph->grid().levels - 2) {}

  // Fills `layers`; returns the voxels of the union.
  ReducedGraph run(LayerTable* layers) {
    roots_ = graph_->roots();
    if (facts_.nodes.empty()) mark();
    for (int level = brick_level_; level >= 0; --level) {
      writer_->begin_level(level);
      Level here(nodes(level), !facts_.voxels.empty(), room_);
      if (level == brick_level_) {
        write_level<BrickRecord, BrickRecordWord>(level, 2, &here);
      } else {
        write_level<NodeRecord, NodeRecordWord>(level, 8, &here);
      }
      below_ = std::move(here);
    }
    return {set_roots(layers), spilled_};
  }

 private:
  // Results for the nodes of one level, by rank.
  struct Level {
    Level() = default;
    Level(uint64_t count, bool voxels_are_known, const WorkRoom& room)
        : index(count, room), voxels(voxels_are_known ? 0 : count, room) {}

    WorkArray<uint32_t> index;   // 1 + index in the output; 0: the node is empty
    WorkArray<uint64_t> voxels;  // number of set voxels below the node, unless known
  };

  void mark() {
    for (int level = 0; level <= brick_level_; ++level)
      marks_.emplace_back(room_.budget, "marks of reached nodes");
    for (const uint32_t root : roots_) {
      if (root != kNoChild) marks_[0].set(root);
    }
    for (int level = 0; level <= brick_level_; ++level) {
      marks_[size_t(level)].seal();
      if (level == brick_level_) break;
      RankBitmap& below = marks_[size_t(level) + 1];
      for_ids(level, [&](uint32_t, uint32_t id) {
        for (const uint32_t child : graph_->children(level, id)) {
          if (child != kNoChild) below.set(child);
        }
      });
    }
  }

  uint64_t nodes(int level) const {
    return marks_.empty() ? facts_.nodes[size_t(level)] : marks_[size_t(level)].count();
  }
  uint32_t rank(int level, uint32_t id) const {
    return marks_.empty() ? id : marks_[size_t(level)].rank(id);
  }
  // The first id in use from `id` on; nothing if there is none.
  std::optional<uint32_t> next_id(int level, uint64_t id) const {
    if (!marks_.empty()) return marks_[size_t(level)].next(id);
    return id < facts_.nodes[size_t(level)] ? std::optional(uint32_t(id)) : std::nullopt;
  }
  // Calls visit(rank, id) for the ids in use from `first` on, the first of which has this rank.
  template <class Visit>
  void for_ids(int level, const Visit& visit, uint64_t first = 0, uint32_t rank = 0) const {
    for (auto id = next_id(level, first); id; id = next_id(level, uint64_t(*id) + 1)) {
      if (rank % 65536 == 0) check_interrupt();
      visit(rank++, *id);
    }
  }

  // Sets the key of a node, and its voxels.
  void get(int, uint32_t id, uint32_t rank, Level* here, Brick* key) {
    *key = graph_->brick(id);
    if (here->voxels.size() != 0) here->voxels[rank] = uint64_t(std::popcount(*key));
  }
  void get(int level, uint32_t id, uint32_t rank, Level* here, NodeKey* key) {
    const std::array<uint32_t, 8> children = graph_->children(level, id);
    uint64_t voxels = 0;
    for (size_t c = 0; c < 8; ++c) {
      (*key)[c] = 0;
      if (children[c] == kNoChild) continue;
      const uint32_t child = this->rank(level + 1, children[c]);
      (*key)[c] = below_.index[child];
      if (here->voxels.size() != 0) voxels += below_.voxels[child];
    }
    if (here->voxels.size() != 0) here->voxels[rank] = voxels;
  }
  uint32_t add(Brick key) { return writer_->add_brick(key); }
  uint32_t add(const NodeKey& key) { return writer_->add_node(key); }

  // The nodes of a level whose contents ascend with their ids.
  template <class Key>
  struct Ascending {
    std::optional<uint32_t> id;  // of the next one
    uint32_t rank = 0;
    Key key{};
  };
  template <class Key>
  void read(int level, uint64_t from, Level* here, Ascending<Key>* next) {
    next->id = next_id(level, from);
    if (next->id && *next->id >= facts_.unique_end) next->id.reset();
    if (next->id) get(level, *next->id, next->rank, here, &next->key);
  }

  // Writes a level: those nodes that ascend as they come, merged with the others, sorted.
  template <class Record, class Word>
  void write_level(int level, size_t words, Level* here) {
    using Key = decltype(Record::key);
    const uint32_t unique_end = level == 0 ? 0 : facts_.unique_end;
    const uint32_t sorted_from = facts_.unique_ascend ? unique_end : 0;
    uint32_t index = 0;
    Key last{};  // no key is zero
    bool last_is_unique = false;
    const auto add_key = [&](const Key& key, uint32_t rank, bool is_unique) {
      if (key != last) {
        index = 1 + add(key);
        last_is_unique = false;
      } else if (is_unique && last_is_unique) {
        fail_input(facts_.path, "damaged file: two nodes of a level are equal");
      }
      last = key;
      last_is_unique = last_is_unique || is_unique;
      here->index[rank] = index;
    };
    Ascending<Key> next;
    if (sorted_from > 0) read(level, 0, here, &next);
    // Adds the ascending nodes up to `end`; without one, the rest.
    const auto add_ascending = [&](const Key* end) {
      while (next.id && (end == nullptr || next.key <= *end)) {
        if (next.key < last)
          fail_input(facts_.path, "damaged file: the nodes of a level do not ascend");
        if (next.rank % 65536 == 0) check_interrupt();
        add_key(next.key, next.rank++, true);
        read(level, uint64_t(*next.id) + 1, here, &next);
      }
    };
    const uint32_t sorted_rank = sorted_from == 0 ? 0 : count_below(level, sorted_from);
    if (const uint64_t count = nodes(level) - sorted_rank; count > 0) {
      ExternalSort<Record, Word> sort(sort_room(count * sizeof(Record)), words, {});
      for_ids(
          level,
          [&](uint32_t rank, uint32_t id) {
            Record record{};
            get(level, id, rank, here, &record.key);
            record.rank = rank;
            record.is_unique = id < unique_end;
            if (!is_empty(record.key)) sort.push(record);
          },
          sorted_from, sorted_rank);
      sort.finish([&](const auto& records) {
        check_interrupt();
        for (const Record& record : records) {
          add_ascending(&record.key);
          add_key(record.key, record.rank, record.is_unique != 0);
        }
      });
      spilled_ += sort.written_bytes() > 0;
    }
    add_ascending(nullptr);
  }

  // The number of ids in use below `end`.
  uint32_t count_below(int level, uint32_t end) const {
    const auto first = next_id(level, end);
    return first ? rank(level, *first) : uint32_t(nodes(level));
  }

  // Buffers for `bytes` bytes of records, at most three quarters of the memory that is left.
  ExternalSortConfig sort_room(uint64_t bytes) const {
    const uint64_t min = 2 * executor_->workers() * ExternalSortConfig::kMinBytesPerWorker;
    const uint64_t limit = room_.budget->limit(), used = std::min(room_.budget->used(), limit);
    const uint64_t max = std::max((limit - used) / 4 * 3, min);
    return {room_.budget, std::clamp(2 * bytes + min, min, max), executor_,
            [this] { return File::create_anonymous(room_.folder); }};
  }

  // Copies the sets to the table, whose order they have. Returns the voxels of the union.
  uint64_t set_roots(LayerTable* layers) const {
    size_t set = 0;
    const auto take = [&](uint32_t* root, uint64_t* voxels) {
      const uint32_t id = roots_[set];
      *root = kNoRoot;
      *voxels = 0;
      if (id != kNoChild) {
        const uint32_t node = rank(0, id);
        if (below_.index[node] != 0) {
          *root = below_.index[node] - 1;
          *voxels = facts_.voxels.empty() ? below_.voxels[node] : facts_.voxels[set];
        }
      }
      ++set;
    };
    uint64_t voxels = 0;
    if (layers->has_union) {
      uint32_t root;
      take(&root, &voxels);
      if (!layers->empty()) layers->union_root = root;
    }
    bool any = false;
    for (Layer& layer : layers->layers) {
      take(&layer.root, &layer.voxels);
      any = any || layer.voxels != 0;
    }
    // Of the solid rules: the format cannot represent an empty union beside a layer that is not
    // empty.
    if (any && voxels == 0) layers->has_union = false;
    return voxels;
  }

  NodeGraph* graph_;
  const GraphFacts facts_;
  const WorkRoom& room_;
  Executor* executor_;
  DagWriter* writer_;
  int brick_level_;
  std::vector<uint32_t> roots_;
  std::vector<RankBitmap> marks_;  // [level]: ids that the roots reach; empty: all are
  Level below_;
  int spilled_ = 0;
};

}  // namespace

ReducedGraph reduce(NodeGraph* graph, const WorkRoom& room, Executor* executor, DagWriter* writer,
                    LayerTable* layers) {
  return Reduction(graph, room, executor, writer).run(layers);
}

}  // namespace svdag
