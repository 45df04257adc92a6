#include "io/dag/walk/cube_walk.h"

#include "io/dag/dag_level.h"
#include "io/dag/dag_stats.h"
#include "streaming/error.h"
#include "streaming/process/interrupt.h"

namespace svdag {
namespace {

enum class Overlap { kNone, kPart, kWhole };

// The overlap of the cube at `origin` with `box`.
Overlap overlap(const LatticePoint& origin, int64_t side, const VoxelBox& box) {
  bool whole = true;
  for (int a = 0; a < 3; ++a) {
    if (origin[a] >= box.max[a] || origin[a] + side <= box.min[a]) return Overlap::kNone;
    whole = whole && origin[a] >= box.min[a] && origin[a] + side <= box.max[a];
  }
  return whole ? Overlap::kWhole : Overlap::kPart;
}

// The voxels of a node of the block level.
Block block_of(const DagView& dag, uint32_t level, uint32_t node) {
  Block block;
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag, level, node, c);
    if (child != kNoChild)
      block.set_brick(c & 4, c << 1 & 4, c << 2 & 4, dag_brick_at(dag, level + 1, child));
  }
  return block;
}

}  // namespace

CubeWalk::CubeWalk(const DagView& dag, uint32_t levels)
    : dag_(dag), levels_(levels), full_(levels - 2), voxels_(levels - 2) {
  SVDAG_ASSERT(levels >= 3 && levels <= dag.levels);
}

CubeWalk::WalkNode CubeWalk::child(const WalkNode& at, unsigned c) const {
  const int64_t half = side(at.level + 1);
  const LatticePoint step((c >> 2 & 1) * half, (c >> 1 & 1) * half, (c & 1) * half);
  return {at.level + 1, dag_child(dag_, at.level, at.node, c), at.origin + step};
}

bool CubeWalk::is_full(uint32_t level, uint32_t node) {
  if (level + 2 == levels_) return dag_brick_at(dag_, level, node) == ~uint64_t(0);
  if (dag_mask(dag_, level, node) != 0xffU) return false;
  if (const auto cached = full_[level].find(node); cached != full_[level].end())
    return cached->second;
  bool all = true;
  for (unsigned c = 0; all && c < 8; ++c) all = is_full(level + 1, dag_child(dag_, level, node, c));
  return full_[level][node] = all;
}

bool CubeWalk::visit(const VoxelBox& box, const VoxelCubeSink& sink) {
  return dag_.empty() || visit({0, 0, LatticePoint(0)}, box, sink);
}

bool CubeWalk::visit(const WalkNode& at, const VoxelBox& box, const VoxelCubeSink& sink) {
  check_interrupt();
  const Overlap overlapping = overlap(at.origin, side(at.level), box);
  if (overlapping == Overlap::kNone) return true;
  if (at.level + 3 == levels_) {
    VoxelCube cube{at.origin, kBlockSide, block_of(dag_, at.level, at.node)};
    if (overlapping == Overlap::kPart) cube.block.cut(at.origin, box);
    return cube.block.empty() || sink(cube);
  }
  if (overlapping == Overlap::kWhole && is_full(at.level, at.node))
    return sink({at.origin, side(at.level), {}});
  for (unsigned c = 0; c < 8; ++c) {
    const WalkNode next = child(at, c);
    if (next.node != kNoChild && !visit(next, box, sink)) return false;
  }
  return true;
}

CubeCounts CubeWalk::count_cubes(const VoxelBox& box, uint64_t max_blocks) {
  CubeCounts counts;
  if (dag_.empty()) return counts;
  // A grid smaller than a cube counts as one cube.
  counts.middle = levels_ < 7 ? 1 : 0;
  counts.large = levels_ < 12 ? 1 : 0;
  count({0, 0, LatticePoint(0)}, box, max_blocks, &counts);
  return counts;
}

void CubeWalk::count(const WalkNode& at, const VoxelBox& box, uint64_t max_blocks,
                     CubeCounts* counts) const {
  if (counts->blocks > max_blocks || overlap(at.origin, side(at.level), box) == Overlap::kNone)
    return;
  counts->large += at.level + 12 == levels_;
  counts->middle += at.level + 7 == levels_;
  if (at.level + 3 == levels_) {
    ++counts->blocks;
    return;
  }
  for (unsigned c = 0; c < 8; ++c) {
    const WalkNode next = child(at, c);
    if (next.node != kNoChild) count(next, box, max_blocks, counts);
  }
}

uint64_t CubeWalk::voxels_below(uint32_t level, uint32_t node) {
  if (level + 2 == levels_) return uint64_t(std::popcount(dag_brick_at(dag_, level, node)));
  if (const auto cached = voxels_[level].find(node); cached != voxels_[level].end())
    return cached->second;
  uint64_t sum = 0;
  for (unsigned c = 0; c < 8; ++c) {
    const uint32_t child = dag_child(dag_, level, node, c);
    if (child != kNoChild) sum += voxels_below(level + 1, child);
  }
  return voxels_[level][node] = sum;
}

bool CubeWalk::covers_grid(const VoxelBox& box) const {
  return box.holds({LatticePoint(0), LatticePoint(side(0))});
}

uint64_t CubeWalk::counting_bytes(const VoxelBox& box) const {
  return covers_grid(box) ? level_counting_bytes(dag_, levels_) : 0;
}

uint64_t CubeWalk::count_voxels(const VoxelBox& box) {
  if (covers_grid(box)) return count_level_voxels(dag_, levels_);  // caches nothing
  return dag_.empty() ? 0 : count_voxels({0, 0, LatticePoint(0)}, box);
}

uint64_t CubeWalk::count_voxels(const WalkNode& at, const VoxelBox& box) {
  check_interrupt();
  const Overlap overlapping = overlap(at.origin, side(at.level), box);
  if (overlapping == Overlap::kNone) return 0;
  if (overlapping == Overlap::kWhole) return voxels_below(at.level, at.node);
  if (at.level + 3 == levels_) {
    Block block = block_of(dag_, at.level, at.node);
    block.cut(at.origin, box);
    return block.count();
  }
  uint64_t sum = 0;
  for (unsigned c = 0; c < 8; ++c) {
    const WalkNode next = child(at, c);
    if (next.node != kNoChild) sum += count_voxels(next, box);
  }
  return sum;
}

// The brick that holds voxel `at`, which is inside the grid.
Brick CubeWalk::brick(const LatticePoint& at) const {
  WalkNode node{0, 0, LatticePoint(0)};
  while (node.level + 2 < levels_) {
    const uint32_t shift = levels_ - 1 - node.level;
    node = child(node, child_index(at.x >> shift & 1, at.y >> shift & 1, at.z >> shift & 1));
    if (node.node == kNoChild) return 0;
  }
  return dag_brick_at(dag_, node.level, node.node);
}

Block CubeWalk::block(const LatticePoint& origin) const {
  Block block;
  if (dag_.empty()) return block;
  const int64_t resolution = int64_t(1) << levels_;
  LatticePoint first, last;  // bricks that the block meets
  for (int a = 0; a < 3; ++a) {
    first[a] = std::max<int64_t>(origin[a] >> 2, 0);
    last[a] = std::min((origin[a] + kBlockSide - 1) >> 2, (resolution - 1) >> 2);
  }
  LatticePoint b;
  for (b.x = first.x; b.x <= last.x; ++b.x)
    for (b.y = first.y; b.y <= last.y; ++b.y)
      for (b.z = first.z; b.z <= last.z; ++b.z) {
        for (Brick bits = brick(b * int64_t(kBrickSide)); bits != 0; bits &= bits - 1) {
          const auto [x, y, z] = brick_voxel(unsigned(std::countr_zero(bits)));
          const LatticePoint at = b * int64_t(kBrickSide) + LatticePoint(x, y, z) - origin;
          if (((at.x | at.y | at.z) & ~int64_t(7)) == 0)
            block.set(unsigned(at.x), unsigned(at.y), unsigned(at.z));
        }
      }
  return block;
}

}  // namespace svdag
