#include "builder/reduce/brick_reduction.h"

#include <bit>

#include "streaming/error.h"

namespace svdag {

BrickReduction::BrickReduction(SubDagBuilder* builder, bool has_layers)
    : builder_(builder), brick_level_(builder->table()->brick_level()), has_layers_(has_layers) {
  builder_->begin(Cube());
  open(Cube());
}

void BrickReduction::open(const Cube& cube) {
  builder_->open(cube, has_layers_ ? std::nullopt : std::optional(SubDagSets()));
}

// Makes the parent of cube `code` of `level` the last cube of the open path.
void BrickReduction::open_path(uint64_t code, int level) {
  const uint64_t brick = code << (3 * (brick_level_ - level));
  SVDAG_ASSERT(brick >= code_);
  const auto holds = [&](int k) { return brick >> (3 * (brick_level_ - k)) == code_at(k); };
  while (open_ >= level || !holds(open_)) builder_->close(open_--);
  code_ = brick;
  while (open_ < level - 1) {
    ++open_;
    open({open_, unmorton(code_at(open_))});
  }
}

void BrickReduction::pause(uint64_t code, int level) {
  const uint64_t voxels = uint64_t(1) << (3 * (builder_->levels() - level));
  builder_->pause(level, (code + 1) * voxels);
}

void BrickReduction::add(uint64_t code, Brick brick) {
  SVDAG_ASSERT(!has_layers_);
  const SubjectBrick of_union{kUnionSet, brick};
  add(code, std::span(&of_union, 1));
}

void BrickReduction::add(uint64_t code, std::span<const SubjectBrick> bricks) {
  open_path(code, brick_level_);
  for (const auto& [subject, brick] : bricks) {
    SVDAG_ASSERT(brick != 0);
    const SubDag dag{builder_->table()->add_brick(brick), uint64_t(std::popcount(brick))};
    builder_->add(brick_level_, code & 7, SubDagSets::only(subject), dag);
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
  builder_->add(level, code & 7, {}, full_cube(level));
  pause(code, level);
}

void BrickReduction::finish() {
  while (open_ >= 0) builder_->close(open_--);
  builder_->end();
}

}  // namespace svdag
