#include "builder/bake/run_collector.h"

#include <algorithm>
#include <optional>

namespace svdag {
namespace {

constexpr uint64_t kMinNodeBytes = 8;  // in a .svdag: a brick, or a node with one child

template <class Key>
uint64_t count_of(const RunLevel<Key>& level) {
  return level.spilled ? level.spilled->bytes / sizeof(Key) : level.keys.size();
}

// The file of any scene that contains this run has all its nodes.
uint64_t min_output_bytes(const Run& run) {
  uint64_t keys = count_of(run.bricks);
  for (const auto& level : run.nodes) keys += count_of(level);
  return keys * kMinNodeBytes;
}

}  // namespace

void RunCollector::add(BakedRun baked) {
  disk_need_->expect_output(output_, min_output_bytes(baked.run));
  set_.add(std::move(baked));
}

void RunCollector::save(BakedRun baked) {
  if (store_ != nullptr) store_->keep(baked, workspace_->scratch()->runs());
  const std::lock_guard lock(mutex_);
  if (!checkpoint_->begun()) {
    if (const auto text = description_->text_if_unchanged()) checkpoint_->begin(*text, grid_);
  }
  if (checkpoint_->begun()) checkpoint_->save_run(baked);
  add(std::move(baked));
  disk_need_->expect_runs(set_.spilled_bytes, std::clamp(voxelizing_->share(), 0.0, 1.0));
}

void RunCollector::add_last(BakedRun baked) {
  if (set_.spilled) return save(std::move(baked));
  if (store_ != nullptr) store_->keep(baked, nullptr);
  add(std::move(baked));
}

void RunCollector::take_from_store() {
  if (store_ == nullptr) return;
  uint64_t left = workspace_->shares().triangles;  // voxelization no longer needs them
  const auto target = [&](uint64_t bytes) -> std::optional<SpillTarget> {
    if (!set_.spilled && bytes <= left) {
      left -= bytes;
      return std::nullopt;
    }
    return new_target(workspace_->scratch(), grid_.levels);
  };
  store_->load_taken(target, [this](BakedRun baked) { add_last(std::move(baked)); });
}

}  // namespace svdag
