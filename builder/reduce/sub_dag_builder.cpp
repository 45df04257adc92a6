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
  first_level_ = cube.level;
  finished_end_ = morton_range(cube, table_.levels()).begin;
}

SubDagBuilder::Pause SubDagBuilder::end(const Cube& cube) {
  const uint64_t end = morton_range(cube, table_.levels()).end;
  const Pause paused = pause(cube.level, end);
  append_range(&finished_, {finished_end_, end});
  return paused;
}

void SubDagBuilder::close(int level, std::vector<SubjectDag>* dags) {
  OpenCube& cube = path_[size_t(level)];
  if (cube.as_roots) make_roots(&cube);
  auto& children = cube.of_layers;
  std::stable_sort(children.begin(), children.end(),
                   [](const auto& a, const auto& b) { return a.subject < b.subject; });
  for (auto at = children.begin(); at != children.end();) {
    const Subject subject = at->subject;
    NodeKey key{};
    uint64_t voxels = 0;
    for (; at != children.end() && at->subject == subject; ++at) {
      key[at->c] = at->root;
      voxels += at->voxels;
    }
    dags->push_back({subject, {table_.add_node(level, key), voxels}});
  }
  children.clear();
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
    for (uint32_t& child : path_[size_t(k)].children) child = table_.settled(k + 1, child);
    for (auto& child : path_[size_t(k)].of_layers) child.root = table_.settled(k + 1, child.root);
  }
  for (; settled_roots_ < roots_.size(); ++settled_roots_) {
    SubDagRoot& root = roots_[settled_roots_];
    root.rank = table_.settled(root.level, 1 + root.rank) - 1;
  }
}

void SubDagBuilder::make_roots(OpenCube* cube) {
  for (unsigned c = 0; c < 8; ++c) add_root(cube->cube.child(c), subject_, cube->children[c]);
  cube->children.fill(0);
  count_voxels(subject_, std::exchange(cube->voxels, 0), &voxels_, &layer_voxels_);
  for (const auto& child : cube->of_layers)
    add_root(cube->cube.child(child.c), child.subject, child.root, child.voxels);
  cube->of_layers.clear();
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
