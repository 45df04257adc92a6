#include "builder/merge.h"

#include <algorithm>

#include "builder/top_tree.h"
#include "streaming/error.h"

namespace svdag {
namespace {

// Merges sorted sequences without repeats into one; add(key) appends to the output and returns the
// global index, which each sequence that holds the key gets into its map.
template <class Key, class Add>
std::vector<HugeVector<uint32_t>> merge_level(const std::vector<std::span<const Key>>& sequences,
                                              Add add) {
  std::vector<HugeVector<uint32_t>> maps(sequences.size());
  for (size_t s = 0; s < sequences.size(); ++s) maps[s].reserve(sequences[s].size());
  const auto head = [&](size_t s) { return sequences[s][maps[s].size()]; };
  const auto ended = [&](size_t s) { return maps[s].size() == sequences[s].size(); };
  for (;;) {
    // One sequence per worker: a linear search for the smallest head beats a heap.
    size_t smallest = sequences.size();
    for (size_t s = 0; s < sequences.size(); ++s) {
      if (!ended(s) && (smallest == sequences.size() || head(s) < head(smallest))) smallest = s;
    }
    if (smallest == sequences.size()) return maps;
    const Key key = head(smallest);
    const uint32_t index = add(key);
    for (size_t s = smallest; s < sequences.size(); ++s) {
      if (!ended(s) && head(s) == key) maps[s].push_back(index);
    }
  }
}

// Rewrites run-local children (1 + rank) to global ones (1 + index).
void rewrite(std::span<NodeKey> nodes, const HugeVector<uint32_t>& map) {
  for (NodeKey& key : nodes) {
    for (uint32_t& child : key) child = child == 0 ? 0 : 1 + map[child - 1];
  }
}

}  // namespace

void merge(std::span<Run> runs, std::span<const CellRoot> roots, int levels, DagWriter* writer,
           Executor* executor) {
  const int brick_level = levels - 2;
  std::vector<HugeVector<uint32_t>> maps;  // [run]: rank -> global index on the level below
  TopTree top(roots);

  writer->begin_level(brick_level);
  std::vector<std::span<const Brick>> bricks;
  for (const Run& run : runs) bricks.emplace_back(run.bricks);
  maps = merge_level(bricks, [&](Brick brick) { return writer->add_brick(brick); });
  top.resolve(brick_level, maps, {});

  for (int level = brick_level - 1; level >= 0; --level) {
    writer->begin_level(level);
    executor->for_each(runs.size(),
                       [&](size_t, size_t r) { rewrite(runs[r].nodes[size_t(level)], maps[r]); });
    const std::vector<NodeKey> above = top.sorted_nodes();
    std::vector<std::span<const NodeKey>> sequences;
    for (const Run& run : runs) sequences.emplace_back(run.nodes[size_t(level)]);
    sequences.emplace_back(above);
    maps = merge_level(sequences, [&](const NodeKey& key) { return writer->add_node(key); });
    for (Run& run : runs) run.nodes[size_t(level)] = {};
    const HugeVector<uint32_t> top_map = std::move(maps.back());
    maps.pop_back();
    top.resolve(level, maps, top_map);
  }
}

}  // namespace svdag
