#include "io/dag/layers/chosen_layers.h"

#include <algorithm>
#include <bit>
#include <map>
#include <memory>
#include <unordered_set>
#include <utility>
#include <vector>

#include "io/dag/dag_writer.h"
#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/memory/rank_bitmap.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr const char* kPurpose = "nodes of the chosen layers";

// The sets of two or more nodes of a level, numbered in the order in which they come.
class NodeSets {
 public:
  explicit NodeSets(MemoryBudget* budget) : memory_(budget->reserve(0, kPurpose)) {}
  NodeSets(const NodeSets&) = delete;

  uint32_t count() const { return uint32_t(ends_.size()); }
  std::span<const uint32_t> operator[](uint32_t set) const {
    const size_t begin = set == 0 ? 0 : ends_[set - 1];
    return {nodes_.data() + begin, ends_[set] - begin};
  }
  // `nodes` ascend.
  uint32_t number(std::span<const uint32_t> nodes) {
    // A new set is stored before it is looked up, and dropped if it is known.
    const size_t before = nodes_.size();
    if (before + nodes.size() > nodes_.capacity() || ends_.size() == ends_.capacity())
      reserve(nodes.size());
    const uint32_t set = as_u32(ends_.size(), "nodes of a level of the union");
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    ends_.push_back(nodes_.size());
    const auto [found, is_new] = numbers_.insert(set);
    if (!is_new) {
      ends_.pop_back();
      nodes_.resize(before);
    }
    return *found;
  }

 private:
  static constexpr size_t kSetBytes = 3 * sizeof(size_t) / 2 + 32;  // of ends_ and numbers_

  // Before arrays double, and are copied.
  void reserve(size_t more) {
    const size_t nodes = std::max(2 * nodes_.size(), nodes_.size() + more);
    memory_.resize(3 * nodes * sizeof(uint32_t) / 2 + 2 * (ends_.size() + 1) * kSetBytes, kPurpose);
  }

  struct Hash {
    const NodeSets* sets;
    size_t operator()(uint32_t set) const {
      uint64_t hash = 0;
      for (const uint32_t node : (*sets)[set])
        hash = (std::rotl(hash, 23) ^ node) * 0x9e3779b97f4a7c15U;
      return hash ^ hash >> 32;
    }
  };
  struct Equal {
    const NodeSets* sets;
    bool operator()(uint32_t a, uint32_t b) const {
      return std::ranges::equal((*sets)[a], (*sets)[b]);
    }
  };

  MemoryBudget::Reservation memory_;
  std::vector<uint32_t> nodes_;
  std::vector<size_t> ends_;
  std::unordered_set<uint32_t, Hash, Equal> numbers_{64, Hash{this}, Equal{this}};
};

class ChosenLayers {
 public:
  ChosenLayers(const DagFile& file, std::span<const size_t> chosen, const WorkRoom& room)
      : file_(file), dag_(file.view()), chosen_(chosen.begin(), chosen.end()), room_(room) {
    for (uint32_t level = 0; level <= dag_.brick_level(); ++level)
      levels_.push_back(std::make_unique<Level>(room.budget));
    for (const size_t layer : chosen_) roots_.push_back(file.view_of(layer));
  }

  // Finds the nodes and sets of all levels but the first.
  void descend() {
    for (unsigned c = 0; c < 8; ++c) {
      children_of_roots(roots_, c);
      for (const uint32_t node : nodes_) levels_[1]->nodes.set(node);
      if (nodes_.size() > 1) levels_[1]->sets.number(nodes_);
    }
    for (uint32_t level = 1; level <= dag_.brick_level(); ++level) {
      check_interrupt();
      levels_[level]->nodes.seal();
      if (level == dag_.brick_level()) return;
      Level& below = *levels_[level + 1];
      levels_[level]->nodes.for_each([&](uint32_t node) {
        dag_for_children(dag_, level, node,
                         [&](unsigned, uint32_t child) { below.nodes.set(child); });
      });
      for (uint32_t set = 0; set < levels_[level]->sets.count(); ++set) {
        for (unsigned c = 0; c < 8; ++c) {
          children_of(level, levels_[level]->sets[set], c);
          if (nodes_.size() > 1) below.sets.number(nodes_);
        }
      }
    }
  }

  DagFile write() {
    DagWriter writer(room_.folder + "/layers.svdag", file_.grid(), file_.rule());
    for (uint32_t level = dag_.brick_level(); level > 0; --level) {
      check_interrupt();
      writer.begin_level(int(level));
      if (level == dag_.brick_level()) {
        write_level<Brick>(level, [&](Brick brick) { return writer.add_brick(brick); });
      } else {
        write_level<NodeKey>(level, [&](const NodeKey& node) { return writer.add_node(node); });
      }
    }
    writer.begin_level(0);
    std::map<NodeKey, uint32_t> numbers;
    const auto add_root = [&](std::span<const DagView> roots, uint64_t* voxels) {
      NodeKey key{};
      *voxels = 0;
      for (unsigned c = 0; c < 8; ++c) {
        children_of_roots(roots, c);
        add_child(1, c, &key, voxels);
      }
      if (*voxels == 0) return kNoRoot;
      const auto [found, is_new] = numbers.try_emplace(key, 0);
      if (is_new) found->second = writer.add_node(key);
      return found->second;
    };
    LayerTable table{file_.layers().kind, true, 0, {}};
    uint64_t voxels = 0;
    table.union_root = add_root(roots_, &voxels);
    for (size_t i = 0; i < chosen_.size(); ++i) {
      Layer& layer = table.layers.emplace_back(file_.layers().layers[chosen_[i]]);
      layer.root = add_root(std::span(roots_).subspan(i, 1), &layer.voxels);
    }
    return writer.finish_unnamed(voxels, file_.header().largest_snap, std::move(table),
                                 file_.path());
  }

 private:
  struct Level {
    explicit Level(MemoryBudget* budget) : nodes(budget, kPurpose), sets(budget) {}

    // The place of a set of nodes in the arrays below: the sets come last.
    uint64_t place(std::span<const uint32_t> set) {
      return set.size() == 1 ? nodes.rank(set[0]) : nodes.count() + sets.number(set);
    }

    RankBitmap nodes;
    NodeSets sets;
    WorkArray<uint32_t> index;   // [place]: in the new file
    WorkArray<uint64_t> voxels;  // [place]
  };

  // Sets nodes_ to the children c of these nodes, ascending, each once.
  void children_of(uint32_t level, std::span<const uint32_t> set, unsigned c) {
    nodes_.clear();
    for (const uint32_t node : set) add_node(dag_child(dag_, level, node, c));
    sort_nodes();
  }
  void children_of_roots(std::span<const DagView> roots, unsigned c) {
    nodes_.clear();
    for (const DagView& dag : roots) {
      if (!dag.empty()) add_node(dag_child(dag, 0, 0, c));
    }
    sort_nodes();
  }
  void add_node(uint32_t node) {
    if (node != kNoChild) nodes_.push_back(node);
  }
  void sort_nodes() {
    std::sort(nodes_.begin(), nodes_.end());
    nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  }
  // Makes nodes_, of a level, child c of the key, and adds their voxels.
  void add_child(uint32_t level, unsigned c, NodeKey* key, uint64_t* voxels) {
    if (nodes_.empty()) return;
    const uint64_t place = levels_[level]->place(nodes_);
    (*key)[c] = 1 + levels_[level]->index[place];
    *voxels += levels_[level]->voxels[place];
  }

  void get(uint32_t, std::span<const uint32_t> set, Brick* key, uint64_t* voxels) {
    for (const uint32_t node : set) *key |= dag_.bricks[node];
    *voxels = uint64_t(std::popcount(*key));
  }
  void get(uint32_t level, std::span<const uint32_t> set, NodeKey* key, uint64_t* voxels) {
    for (unsigned c = 0; c < 8; ++c) {
      children_of(level, set, c);
      add_child(level + 1, c, key, voxels);
    }
  }

  // Writes the nodes and the sets of a level in one order. Sets may be equal to each other and to
  // nodes.
  template <class Key, class Add>
  void write_level(uint32_t level, const Add& add) {
    Level& here = *levels_[level];
    const uint64_t nodes = here.nodes.count();
    const uint32_t sets = here.sets.count();
    here.index = WorkArray<uint32_t>(nodes + sets, room_);
    here.voxels = WorkArray<uint64_t>(nodes + sets, room_);
    const auto memory = room_.budget->reserve(sets * sizeof(std::pair<Key, uint32_t>), kPurpose);
    std::vector<std::pair<Key, uint32_t>> keys(sets);
    for (uint32_t set = 0; set < sets; ++set) {
      keys[set].second = set;
      get(level, here.sets[set], &keys[set].first, &here.voxels[nodes + set]);
    }
    std::sort(keys.begin(), keys.end());
    size_t next = 0;
    // Writes the sets before `key`; without one, the rest.
    const auto write_sets = [&](const Key* key) {
      while (next < sets && (key == nullptr || keys[next].first < *key)) {
        const Key same = keys[next].first;
        const uint32_t index = add(same);
        for (; next < sets && keys[next].first == same; ++next)
          here.index[nodes + keys[next].second] = index;
      }
    };
    uint64_t rank = 0;
    here.nodes.for_each([&](uint32_t node) {
      Key key{};
      get(level, {&node, 1}, &key, &here.voxels[rank]);
      write_sets(&key);
      const uint32_t index = add(key);
      here.index[rank++] = index;
      for (; next < sets && keys[next].first == key; ++next)
        here.index[nodes + keys[next].second] = index;
    });
    write_sets(nullptr);
    if (level < dag_.brick_level()) levels_[level + 1].reset();
  }

  const DagFile& file_;
  const DagView& dag_;
  std::vector<size_t> chosen_;
  const WorkRoom& room_;
  std::vector<DagView> roots_;  // of the chosen layers
  std::vector<std::unique_ptr<Level>> levels_;
  std::vector<uint32_t> nodes_;
};

}  // namespace

DagFile chosen_layers(const DagFile& file, std::span<const size_t> chosen, const WorkRoom& room) {
  SVDAG_ASSERT(file.layout() == Layout::kPlain);
  ChosenLayers layers(file, chosen, room);
  layers.descend();
  return layers.write();
}

}  // namespace svdag
