#include "builder/merge/merge.h"

#include <algorithm>
#include <mutex>

#include "builder/merge/merge_level.h"
#include "builder/merge/top_tree.h"
#include "builder/run/run_file.h"
#include "builder/workspace/memory_shares.h"

namespace svdag {
namespace {

class Merger {
 public:
  Merger(std::span<Run> runs, std::vector<SubDagRoot> roots, const GridPart& part,
         const MergeConfig& config, BakeOutput* output, Executor* executor)
      : runs_(runs),
        config_(config),
        top_(std::move(roots), part, config.with_union),
        output_(output),
        executor_(executor) {}

  std::vector<SubDagRoot> run(int brick_level) {
    begin_progress(brick_level);
    output_->begin_level(brick_level);
    std::vector<LevelInput<Brick>> bricks;
    for (const Run& run : runs_) bricks.push_back(input_from(run.bricks, brick_level));
    maps_ = merge_level<Brick>(bricks, 0);
    for (Run& run : runs_) run.bricks = {};
    for (int level = brick_level - 1; level >= 0; --level) run_level(level);
    resolve_last();
    return top_.take_tops();
  }

 private:
  void begin_progress(int brick_level) {
    if (config_.progress == nullptr) return;
    uint64_t keys = 0;
    for (const Run& run : runs_) {
      keys += input_from(run.bricks, brick_level).count();
      for (int level = 0; level < brick_level; ++level)
        keys += input_from(run.nodes[size_t(level)], level).count();
    }
    config_.progress->phase("merge", keys, "nodes");
  }
  void advance(uint64_t keys, uint64_t nodes) {
    if (config_.progress != nullptr) config_.progress->advance(keys, nodes);
  }

  // Replaces the children of the nodes of `level` by their indices in the merged level below, then
  // merges `level`.
  void run_level(int level) {
    const RankMaps below = std::move(maps_);
    resolve_own(below);
    std::vector<SpillStream> rewritten(runs_.size());
    std::vector<LevelInput<NodeKey>> inputs(runs_.size());
    executor_->for_each(runs_.size(), [&](size_t, size_t r) {
      inputs[r] = rewritten_input(level, r, below, &rewritten[r]);
    });
    top_.end_level(level + 1);
    inputs.push_back({top_.sorted_nodes(), {}, 0, nullptr});
    output_->begin_level(level);
    maps_ = merge_level<NodeKey>(inputs, below.resident_bytes());
    for (Run& run : runs_) run.nodes[size_t(level)] = {};
    for (const SpillStream& stream : rewritten) {
      if (!stream.blocks.empty()) config_.scratch->transient()->free(stream);
    }
    for (size_t s = 0; below.spilled() && s < below.size(); ++s) below.free(s);
  }

  // Resolves level 0, which has no level above.
  void resolve_last() {
    resolve_own(maps_);
    for (size_t r = 0; r < runs_.size(); ++r) {
      maps_.spilled() ? top_.resolve_run(0, uint32_t(r), maps_.load(r))  // one node at most
                      : top_.resolve_run(0, uint32_t(r), maps_.resident(r));
    }
    top_.end_level(0);
  }

  // The top tree is the last source, after the runs.
  void resolve_own(const RankMaps& maps) {
    const size_t own = runs_.size();
    if (maps.size() <= own) return;
    maps.spilled() ? top_.resolve_own(maps.load(own)) : top_.resolve_own(maps.resident(own));
  }

  // Run r at `level` as an input whose children are indices of the merged level below. A level in a
  // file is rewritten while it is read if its map is in memory, otherwise here, into *rewritten.
  LevelInput<NodeKey> rewritten_input(int level, size_t r, const RankMaps& below,
                                      SpillStream* rewritten) {
    RunLevel<NodeKey>& nodes = runs_[r].nodes[size_t(level)];
    if (below.spilled()) return rewritten_by_windows(level, r, below, rewritten);
    const RankMap& map = below.resident(r);
    resolve_roots(level + 1, r, map);
    if (in_memory(nodes)) rewrite(nodes.keys, map);
    return input_from(nodes, level, &map);
  }

  LevelInput<NodeKey> rewritten_by_windows(int level, size_t r, const RankMaps& below,
                                           SpillStream* rewritten) {
    RunLevel<NodeKey>& nodes = runs_[r].nodes[size_t(level)];
    LevelInput<NodeKey> input = input_from(nodes, level);
    const uint64_t window = std::max<uint64_t>(1, config_.window_bytes / sizeof(uint32_t));
    for (uint64_t end = below.count(r); end > 0;) {
      const uint64_t begin = end > window ? end - window : 0;
      const RankMap map = below.load(r, begin, end);
      resolve_roots(level + 1, r, map);
      end = begin;
      if (in_memory(nodes)) {
        rewrite_window(nodes.keys, map);
      } else {
        SpillStream next = rewrite_stream(input, map);
        config_.scratch->transient()->free(*rewritten);
        *rewritten = std::move(next);
        input = spilled_input<NodeKey>(config_.scratch->transient(), *rewritten, config_.budget);
      }
    }
    return input;
  }

  SpillStream rewrite_stream(const LevelInput<NodeKey>& input, const RankMap& map) {
    const std::unique_ptr<BlockSource> blocks = input.blocks();
    SpillWriter writer(config_.scratch->transient(), config_.scratch->new_streams(),
                       config_.budget);
    for (auto block = blocks->next(); !block.empty(); block = blocks->next()) {
      check_interrupt();
      const std::span keys(reinterpret_cast<NodeKey*>(block.data()),
                           block.size() / sizeof(NodeKey));
      rewrite_window(keys, map);
      writer.append(block);
    }
    return writer.finish();
  }

  void resolve_roots(int level, size_t r, const RankMap& map) {
    const std::lock_guard lock(top_mutex_);
    top_.resolve_run(level, uint32_t(r), map);
  }

  template <class Key>
  static bool in_memory(const RunLevel<Key>& level) {
    return !level.spilled && level.file == nullptr;
  }

  template <class Key>
  LevelInput<Key> input_from(const RunLevel<Key>& keys, int level, const RankMap* map = nullptr) {
    MemoryBudget* const budget = config_.budget;
    if (keys.spilled)
      return spilled_input<Key>(config_.scratch->runs(), *keys.spilled, budget, map);
    const RunFile* const file = keys.file;
    if (file == nullptr) return {keys.keys, {}, 0, nullptr};
    const auto open = [file, level, budget] { return file->read(level, budget); };
    return {{}, open, file->key_count(level) * sizeof(Key), map};
  }

  // `held`: bytes of the resident maps that the inputs use.
  template <class Key>
  RankMaps merge_level(std::span<const LevelInput<Key>> inputs, uint64_t held) {
    uint64_t keys = 0;
    for (const auto& input : inputs) keys += input.count();
    const auto progress = [this](uint64_t of_inputs, uint64_t of_output) {
      advance(of_inputs, of_output);
    };
    const bool many = inputs.size() > config_.max_sources;
    const bool spill = many || held + keys * sizeof(uint32_t) > config_.map_bytes;
    if (config_.scratch == nullptr || !spill)
      return merge_at_once<Key>(inputs, output_, progress, nullptr, config_.budget, executor_);
    return merge_in_groups<Key>(inputs, output_, progress, config_.max_sources, config_.scratch,
                                config_.budget, executor_);
  }

  std::span<Run> runs_;
  const MergeConfig& config_;
  TopTree top_;
  std::mutex top_mutex_;
  BakeOutput* output_;
  Executor* executor_;
  RankMaps maps_;  // of the level merged last: one per run, then that of the top tree
};

}  // namespace

MergeConfig share_for_merge(MemoryBudget* budget, Scratch* scratch, size_t workers,
                            uint64_t source_bytes, Progress* progress) {
  const MemoryShares shares(budget->limit(), workers);
  return {budget,
          scratch,
          shares.maps,
          shares.map_window,
          std::max<size_t>(2, shares.sources / source_bytes),
          progress,
          true};
}

std::vector<SubDagRoot> merge(std::span<Run> runs, std::vector<SubDagRoot> roots,
                              const GridPart& part, const MergeConfig& config, BakeOutput* output,
                              Executor* executor) {
  return Merger(runs, std::move(roots), part, config, output, executor).run(part.levels() - 2);
}

}  // namespace svdag
