#include "builder/merge.h"

#include <mutex>
#include <numeric>

#include "builder/merge_level.h"

namespace svdag {
namespace {

class Merger {
 public:
  Merger(std::span<Run> runs, std::vector<CellRoot> roots, const MergeConfig& config,
         DagWriter* writer, Executor* executor)
      : runs_(runs),
        config_(config),
        top_(std::move(roots)),
        writer_(writer),
        executor_(executor) {}

  void run(int brick_level) {
    writer_->begin_level(brick_level);
    std::vector<LevelInput<Brick>> bricks;
    for (const Run& run : runs_) bricks.push_back(input_from(run.bricks));
    maps_ = merge_level<Brick>(bricks, 0, [&](Brick brick) { return writer_->add_brick(brick); });
    for (Run& run : runs_) run.bricks = {};
    for (int level = brick_level - 1; level >= 0; --level) run_level(level);
  }

 private:
  // The children of `level`'s nodes get their indices on the level below, then the level is merged.
  void run_level(int level) {
    const RankMaps below = std::move(maps_);
    const size_t own = runs_.size();  // the source after the runs is the top tree
    if (below.size() > own) {
      below.spilled() ? top_.resolve_own(below.load(own)) : top_.resolve_own(below.resident(own));
    }
    std::vector<SpillStream> rewritten(runs_.size());
    std::vector<LevelInput<NodeKey>> inputs(runs_.size());
    executor_->for_each(runs_.size(), [&](size_t, size_t r) {
      inputs[r] = rewritten_input(level, r, below, &rewritten[r]);
    });
    top_.end_level();
    inputs.push_back({top_.sorted_nodes()});
    writer_->begin_level(level);
    maps_ = merge_level<NodeKey>(inputs, below.resident_bytes(),
                                 [&](const NodeKey& key) { return writer_->add_node(key); });
    for (Run& run : runs_) run.nodes[size_t(level)] = {};
    for (const SpillStream& stream : rewritten) {
      if (!stream.blocks.empty()) config_.scratch->passing()->free(stream);
    }
    for (size_t s = 0; below.spilled() && s < below.size(); ++s) below.free(s);
  }

  // Run r at `level` as an input whose children are those of the level below. A spilled level is
  // rewritten while it is read if its map stays, else now, to *rewritten.
  LevelInput<NodeKey> rewritten_input(int level, size_t r, const RankMaps& below,
                                      SpillStream* rewritten) {
    RunLevel<NodeKey>& nodes = runs_[r].nodes[size_t(level)];
    if (!below.spilled()) {
      const RankMap& map = below.resident(r);
      resolve_roots(level + 1, r, map);
      if (!nodes.spilled) rewrite(nodes.keys, map);
      return input_from(nodes, &map);
    }
    const RankMap map = below.load(r);
    resolve_roots(level + 1, r, map);
    if (!nodes.spilled) {
      rewrite(nodes.keys, map);
      return input_from(nodes);
    }
    SpillReader reader(config_.scratch->runs(), *nodes.spilled, config_.budget);
    SpillWriter writer(config_.scratch->passing(), config_.scratch->new_streams(), config_.budget);
    for (auto block = reader.next(); !block.empty(); block = reader.next()) {
      check_interrupt();
      rewrite({reinterpret_cast<NodeKey*>(block.data()), block.size() / sizeof(NodeKey)}, map);
      writer.append(block);
    }
    *rewritten = writer.finish();
    return {{}, config_.scratch->passing(), rewritten, nullptr};
  }

  void resolve_roots(int level, size_t r, const RankMap& map) {
    const std::lock_guard lock(top_mutex_);
    top_.resolve_run(level, uint32_t(r), map);
  }

  template <class Key>
  LevelInput<Key> input_from(const RunLevel<Key>& level, const RankMap* map = nullptr) {
    if (!level.spilled) return {level.keys};
    return {{}, config_.scratch->runs(), &*level.spilled, map};
  }

  // `held`: bytes of the maps that the inputs look into.
  template <class Key, class Add>
  RankMaps merge_level(std::span<const LevelInput<Key>> inputs, uint64_t held, const Add& add) {
    uint64_t keys = 0;
    for (const auto& input : inputs) keys += input.count();
    const bool many = inputs.size() > config_.sources;
    const bool spill = many || held + keys * sizeof(uint32_t) > config_.map_bytes;
    if (config_.scratch == nullptr || !spill)
      return merge_at_once<Key>(inputs, add, nullptr, config_.budget);
    return merge_in_groups<Key>(inputs, add, config_.sources, config_.scratch, config_.budget);
  }

  std::span<Run> runs_;
  const MergeConfig& config_;
  TopTree top_;
  std::mutex top_mutex_;
  DagWriter* writer_;
  Executor* executor_;
  RankMaps maps_;  // of the level merged last: one per run, then the top tree's
};

}  // namespace

void merge(std::span<Run> runs, std::vector<CellRoot> roots, int levels, const MergeConfig& config,
           DagWriter* writer, Executor* executor) {
  Merger(runs, std::move(roots), config, writer, executor).run(levels - 2);
}

}  // namespace svdag
