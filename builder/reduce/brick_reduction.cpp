#include "builder/reduce/brick_reduction.h"

#include <algorithm>
#include <optional>

#include "streaming/counts.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

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

// Completes the cubes of the path in which brick `code` does not lie.
void BrickReduction::leave_for(uint64_t code) {
  const int brick_level = table_.brick_level();
  SVDAG_ASSERT(!any_ || code > code_);
  for (int level = brick_level - 1; any_ && level > 0; --level) {
    if (code >> (3 * (brick_level - level)) == code_at(level)) break;
    close(level);
  }
  any_ = true;
}

void BrickReduction::add(uint64_t code, Brick brick) {
  SVDAG_ASSERT(brick != 0);
  leave_for(code);
  code_ = code;
  path_.back().children[code & 7] = table_.add_brick(brick);
  settle_if_full();
}

void BrickReduction::add_full(uint64_t code, int level) {
  const int brick_level = table_.brick_level();
  SVDAG_ASSERT(level >= 0 && level < brick_level);
  if (level == 0) {  // the path begins at the root, so its parts are put in
    for (uint64_t c = 0; c < 8; ++c) brick_level == 1 ? add(c, ~Brick(0)) : add_full(c, 1);
    return;
  }
  leave_for(code << 3 * (brick_level - level));
  code_ = ((code + 1) << 3 * (brick_level - level)) - 1;  // its last brick
  uint32_t handle = table_.add_brick(~Brick(0));
  for (int k = brick_level - 1; k >= level; --k) {
    NodeKey children;
    children.fill(handle);
    handle = table_.add_node(k, children);
  }
  path_[size_t(level) - 1].children[code & 7] = handle;
  settle_if_full();
}

void BrickReduction::settle_if_full() {
  if (!table_.full()) return;
  flush();
  check_interrupt();
  if (freeze_bytes(table_) < config_.table_bytes) return;
  for (int level = 0; level < table_.brick_level(); ++level) make_parts(level);
  freeze(true);
}

void BrickReduction::finish() {
  for (int level = table_.brick_level() - 1; any_ && level >= 0; --level) close(level);
  flush();
  freeze(spilled_);
}

// The cube of the path at `level` is complete. There is none below a cube that was put in whole.
void BrickReduction::close(int level) {
  Step& step = path_[size_t(level)];
  if (step.divided) {
    make_parts(level);
  } else if (step.children != NodeKey{}) {
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
