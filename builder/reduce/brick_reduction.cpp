#include "builder/reduce/brick_reduction.h"

#include <bit>

#include "streaming/error.h"

namespace svdag {

BrickReduction::BrickReduction(SubDagBuilder* builder, bool has_layers)
    : builder_(builder), brick_level_(builder->table()->brick_level()), has_layers_(has_layers) {
  builder_->begin(Cube());
  builder_->open(Cube());
}

void BrickReduction::close_last() {
  const unsigned c = code_at(open_) & 7;
  if (has_layers_) {
    dags_.clear();
    builder_->close(open_, &dags_);
    for (const auto& [subject, dag] : dags_) builder_->add_child(open_ - 1, c, subject, dag);
  } else {
    builder_->add_child(open_ - 1, c, builder_->close(open_));
  }
  --open_;
}

// Makes the parent of cube `code` of `level` the last cube of the open path.
void BrickReduction::open_path(uint64_t code, int level) {
  const uint64_t brick = code << (3 * (brick_level_ - level));
  SVDAG_ASSERT(brick >= code_);
  const auto holds = [&](int k) { return brick >> (3 * (brick_level_ - k)) == code_at(k); };
  while (open_ >= level || !holds(open_)) close_last();
  code_ = brick;
  while (open_ < level - 1) {
    ++open_;
    builder_->open({open_, unmorton(code_at(open_))});
  }
}

void BrickReduction::add_child(uint64_t code, int level, const SubDag& dag) {
  builder_->add_child(level - 1, code & 7, dag);
  pause(code, level);
}

void BrickReduction::pause(uint64_t code, int level) {
  const uint64_t voxels = uint64_t(1) << (3 * (builder_->levels() - level));
  builder_->pause(level, (code + 1) * voxels);
}

void BrickReduction::add(uint64_t code, Brick brick) {
  SVDAG_ASSERT(brick != 0 && !has_layers_);
  open_path(code, brick_level_);
  add_child(code, brick_level_,
            {builder_->table()->add_brick(brick), uint64_t(std::popcount(brick))});
}

void BrickReduction::add(uint64_t code, std::span<const SubjectBrick> bricks) {
  SVDAG_ASSERT(has_layers_);
  open_path(code, brick_level_);
  for (const auto& [subject, brick] : bricks) {
    const SubDag dag{builder_->table()->add_brick(brick), uint64_t(std::popcount(brick))};
    builder_->add_child(brick_level_ - 1, code & 7, subject, dag);
  }
  pause(code, brick_level_);
}

SubDag BrickReduction::full_cube(int level) {
  uint32_t handle = builder_->table()->add_brick(~Brick(0));
  for (int k = brick_level_ - 1; k >= level; --k) {
    NodeKey children;
    children.fill(handle);
    handle = builder_->table()->add_node(k, children);
  }
  return {handle, uint64_t(1) << (3 * (builder_->levels() - level))};
}

void BrickReduction::add_full(uint64_t code, int level) {
  SVDAG_ASSERT(level >= 0 && level < brick_level_);
  if (level == 0) {  // the open path begins at the root, so its children are added
    for (uint64_t c = 0; c < 8; ++c) brick_level_ == 1 ? add(c, ~Brick(0)) : add_full(c, 1);
    return;
  }
  open_path(code, level);
  add_child(code, level, full_cube(level));
}

void BrickReduction::finish() {
  while (open_ > 0) close_last();
  if (!has_layers_) {
    builder_->end(Cube(), builder_->close(0));
    return;
  }
  dags_.clear();
  builder_->close(0, &dags_);
  builder_->end(Cube(), dags_);
}

}  // namespace svdag
