#include "builder/brick_reduction.h"

#include <algorithm>
#include <optional>

#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/interrupt.h"

namespace svdag {
namespace {

constexpr uint64_t kBytesPerPending = 48;  // a key not yet numbered, and its number

size_t batch_of(uint64_t table_bytes) {
  return size_t(
      std::clamp<uint64_t>(table_bytes / 8 / kBytesPerPending, 1 << 10, NodeTable::kLargestBatch));
}

}  // namespace

BrickReduction::BrickReduction(int levels, const BrickReductionConfig& config)
    : config_(config),
      table_(levels, config.budget, batch_of(config.table_bytes)),
      path_(size_t(levels - 2)) {}

void BrickReduction::add(uint64_t code, Brick brick) {
  const int brick_level = table_.brick_level();
  SVDAG_ASSERT(brick != 0 && (!any_ || code > code_));
  for (int level = brick_level - 1; any_ && level > 0; --level) {
    if (code >> (3 * (brick_level - level)) == code_at(level)) break;
    close(level);
  }
  code_ = code;
  any_ = true;
  path_.back().children[code & 7] = table_.add_brick(brick);
  if (!table_.full()) return;
  flush();
  check_interrupt();
  if (freeze_bytes(table_) >= config_.table_bytes) {
    for (int level = 0; level < brick_level; ++level) make_parts(level);
    freeze(true);
  }
}

void BrickReduction::finish() {
  for (int level = table_.brick_level() - 1; any_ && level >= 0; --level) close(level);
  flush();
  freeze(spilled_);
}

// The cube of the path at `level` is complete.
void BrickReduction::close(int level) {
  Step& step = path_[size_t(level)];
  if (step.divided) {
    make_parts(level);
  } else {
    const uint32_t handle = table_.add_node(level, step.children);
    if (level == 0) {
      parts_.push_back({0, 0, handle});
    } else {
      path_[size_t(level) - 1].children[code_at(level) & 7] = handle;
    }
  }
  step = {};
}

// The children of the cube of the path at `level` become parts of their own.
void BrickReduction::make_parts(int level) {
  Step& step = path_[size_t(level)];
  for (unsigned c = 0; c < 8; ++c) {
    if (step.children[c] != 0)
      parts_.push_back({code_at(level) << 3 | c, level + 1, step.children[c]});
  }
  step = {{}, true};
}

void BrickReduction::flush() {
  table_.flush();
  for (int level = 0; level < table_.brick_level(); ++level) {
    for (uint32_t& child : path_[size_t(level)].children) child = table_.settled(level + 1, child);
  }
  for (Part& part : parts_) part.handle = table_.settled(part.level, part.handle);
}

void BrickReduction::freeze(bool spill) {
  std::vector<NodeNumber> numbers;
  for (const Part& part : parts_) numbers.push_back({part.level, part.handle - 1});
  std::optional<SpillTarget> target;
  if (spill)
    target = {config_.scratch->runs(), config_.scratch->new_streams(uint64_t(table_.levels()))};
  Run run = svdag::freeze(&table_, numbers, target ? &*target : nullptr);
  const uint32_t number = as_u32(runs_.size(), "runs");
  for (size_t i = 0; i < numbers.size(); ++i)
    roots_.push_back({parts_[i].morton, numbers[i].level, number, numbers[i].number});
  runs_.push_back(std::move(run));
  parts_.clear();
  spilled_ = spilled_ || spill;
}

}  // namespace svdag
