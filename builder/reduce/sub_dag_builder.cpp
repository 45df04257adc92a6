#include "builder/reduce/sub_dag_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

constexpr double kMinSeconds = 1;          // a younger table is emptied only if it is full
constexpr uint64_t kBytesPerPending = 48;  // a pending key and its number

// Pending keys take at most an eighth of the table's share.
size_t batch_of(uint64_t table_bytes) {
  return size_t(
      std::clamp<uint64_t>(table_bytes / 8 / kBytesPerPending, 1 << 10, NodeTable::kLargestBatch));
}

}  // namespace

SubDagBuilder::SubDagBuilder(int levels, SubDagBuilderConfig config)
    : config_(std::move(config)),
      table_(levels, config_.budget, batch_of(config_.table_bytes)),
      path_(size_t(levels)) {}

void SubDagBuilder::begin(const Cube& cube) {
  begun_ = cube;
  first_level_ = cube.level;
  finished_end_ = morton_range(cube, table_.levels()).begin;
}

SubDagBuilder::Pause SubDagBuilder::end() {
  const uint64_t end = morton_range(begun_, table_.levels()).end;
  const Pause paused = pause(begun_.level, end);
  append_range(&finished_, {finished_end_, end});
  return paused;
}

// A sub-DAG that a layer shares with the union is a child in both.
void SubDagBuilder::add_to_several(OpenCube* parent, unsigned c, SubDagSets sets,
                                   const SubDag& dag) {
  const auto add_to = [&](Subject subject) {
    const auto at = std::ranges::lower_bound(parent->nodes, subject, {}, &OpenNode::subject);
    const bool found = at != parent->nodes.end() && at->subject() == subject;
    OpenNode& node = found ? *at : *parent->nodes.insert(at, {SubDagSets::only(subject)});
    node.add(c, dag);
  };
  if (sets.in_union && config_.with_union) add_to(kUnionSet);
  if (is_layer(sets.subject)) add_to(sets.subject);
}

void SubDagBuilder::close(int level) {
  OpenCube& cube = path_[size_t(level)];
  if (cube.as_roots) return make_roots(&cube);
  const unsigned c = cube.cube.index_in_parent();
  for (const OpenNode& node : cube.nodes) {
    if (node.voxels != 0)
      add(level, c, node.sets, {table_.add_node(level, node.children), node.voxels});
  }
}

bool SubDagBuilder::is_late() const {
  return config_.empty_table && !std::isinf(config_.max_seconds) &&
         age() >= std::max(config_.max_seconds, kMinSeconds) &&
         (table_.pending() != 0 || freeze_bytes(table_) != 0);
}

SubDagBuilder::Pause SubDagBuilder::pause(int level, uint64_t reached) {
  if (!table_.full() && !is_late()) return Pause::kNone;
  flush(level);
  check_interrupt();
  if (!config_.empty_table) return Pause::kFlushed;
  const uint64_t bytes = freeze_bytes(table_);
  const bool due = bytes >= config_.table_bytes ||
                   (bytes != 0 && !std::isinf(config_.max_seconds) && age() >= config_.max_seconds);
  if (!due) return Pause::kFlushed;
  append_range(&finished_, {finished_end_, reached});
  finished_end_ = reached;
  for (int k = first_level_; k < level; ++k) {
    path_[size_t(k)].as_roots = true;
    make_roots(&path_[size_t(k)]);
  }
  config_.empty_table();
  reset();
  return Pause::kEmptied;
}

void SubDagBuilder::reset() {
  roots_.clear();
  settled_roots_ = 0;
  voxels_ = 0;
  layer_voxels_.clear();
  finished_.clear();
  emptied_ = Clock::now();
}

void SubDagBuilder::flush(int level) {
  table_.flush();
  for (int k = first_level_; k < level; ++k) {
    for (OpenNode& node : path_[size_t(k)].nodes) {
      for (uint32_t& child : node.children) child = table_.settled(k + 1, child);
    }
  }
  for (; settled_roots_ < roots_.size(); ++settled_roots_) {
    SubDagRoot& root = roots_[settled_roots_];
    root.rank = table_.settled(root.level, 1 + root.rank) - 1;
  }
}

void SubDagBuilder::add_root(const Cube& cube, SubDagSets sets, uint32_t node, uint64_t voxels) {
  if (!is_layer(sets.subject) && !config_.with_union) return;
  roots_.push_back({morton(cube.coordinate), cube.level, 0, node - 1, sets});
  count_voxels(sets, voxels, &voxels_, &layer_voxels_);
}

void SubDagBuilder::make_roots(OpenCube* cube) {
  for (OpenNode& node : cube->nodes) {
    uint64_t voxels = std::exchange(node.voxels, 0);  // counted with the first root
    for (unsigned c = 0; c < 8; ++c) {
      if (const uint32_t child = std::exchange(node.children[c], 0); child != 0)
        add_root(cube->cube.child(c), node.sets, child, std::exchange(voxels, 0));
    }
  }
}

BakedRun SubDagBuilder::take_run(const SpillTarget* target) {
  settle();
  BakedRun baked;
  baked.roots = std::move(roots_);
  baked.voxels = voxels_;
  baked.layer_voxels = std::move(layer_voxels_);
  baked.finished = std::move(finished_);
  baked.run = freeze(&table_, baked.roots, target);
  reset();
  return baked;
}

}  // namespace svdag
